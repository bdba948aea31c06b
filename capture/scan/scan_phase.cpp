// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/scan.h"

namespace weft::capture {

const char* name_of(ScanPhase phase) {
  switch (phase) {
    case ScanPhase::kConnecting:
      return "connecting";
    case ScanPhase::kMetering:
      return "metering";
    case ScanPhase::kCooling:
      return "cooling";
    case ScanPhase::kExposing:
      return "exposing";
    case ScanPhase::kFetching:
      return "fetching";
    case ScanPhase::kRecovering:
      return "recovering";
    case ScanPhase::kPaused:
      return "paused";
    case ScanPhase::kFinishing:
      return "finishing";
    case ScanPhase::kComplete:
      return "complete";
    case ScanPhase::kCancelled:
      return "cancelled";
    case ScanPhase::kFailed:
      return "failed";
  }
  return "failed";
}

}  // namespace weft::capture
