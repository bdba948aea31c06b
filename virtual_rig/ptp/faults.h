// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace weft::virtual_rig::ptp {

/// What may befall a camera: fault_kinds() has a sentence on each.
enum class PtpFault : std::uint8_t {
  kDropInExposure,
  kDropBeforeObject,
  kDropInData,
  kOldShot,
  kNoAnswer,
  kDataStalls,
  kDataEndsEarly,
  kOpenSessionSilent,
  kCardFull,
  kTurnedAway,
  kRefused,
  kCaptureBusy,
  kBusyForEver,
  kNoObject,
  kObjectSizeLie,
  kShortData,
  kNoCaptureComplete,
  kPropertyNoise,
  kUnsupportedProperty,
  kFileLate,
  kDuplicateFrame,
  kPowerCycle,
  kPowerOff,
  kPowerOffInData,
  kPowerOffNow,
  kPowerOn,
  kBatteryLow,
  kDialTurned,
  kRawOff,
  kExposureChanged,
  kClockBack,
  kClockAhead,
  kClockReset,
  kAutoIsoOn,
  kLongNoiseOn,
  kUsbUnplug,
  kUsbUnplugInData,
  kUsbUnplugNow,
  kUsbReplug,
  kUsbClaimed,
  kUsbTimeout,
  kUsbStaleSession,
  kLiveStalls,
  kLiveEnds,
  kNeverLive,
  kWell,
};

/// What a fault waits for.
enum class Befalls {
  kShot,        ///< an exposure
  kConnection,  ///< a host that connects
  kBefore,      ///< the end of the exposure before; at once for the first
  kLook,        ///< a picture of live view
};

/// A fault and what is told of it.
struct PtpFaultKind {
  PtpFault fault;
  Befalls befalls;
  const char* name;      ///< "drop_in_exposure"
  const char* sentence;  ///< for people
};

/// Each kind once, in the order of PtpFault.
std::span<const PtpFaultKind> fault_kinds();
/// Nothing for a name that no kind has.
const PtpFaultKind* find_fault(std::string_view name);

/// Faults that wait for their turn. Not safe from several threads.
class FaultSchedule {
 public:
  void add(PtpFault fault, int at) { waiting_.push_back({fault, at}); }
  /// Whether it befalls turn `now`; if so, it has.
  bool take(PtpFault fault, int now);
  bool waits(PtpFault fault, int at) const;
  void forget() { waiting_.clear(); }

 private:
  struct Waiting {
    PtpFault fault;
    int at;
  };
  std::vector<Waiting> waiting_;
};

}  // namespace weft::virtual_rig::ptp
