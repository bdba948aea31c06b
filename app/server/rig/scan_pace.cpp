// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/scan_pace.h"

#include <algorithm>
#include <utility>

namespace weft::app {
namespace {

constexpr int kEnoughShots = 2;

bool is_waiting(capture::ScanPhase phase) {
  using capture::ScanPhase;
  return phase == ScanPhase::kConnecting || phase == ScanPhase::kRecovering || phase == ScanPhase::kPaused;
}

}  // namespace

void ScanPace::follow(const capture::ScanStatus& status, Time now) {
  if (before_ && !waits_) worked_s_ += std::chrono::duration<double>(now - *before_).count();
  before_ = now;
  waits_ = is_waiting(status.phase);
  const int more = status.frames - std::exchange(frames_, status.frames);
  if (status.phase == capture::ScanPhase::kExposing && !std::exchange(has_begun_, true)) worked_s_ = 0;
  if (!has_begun_ || more == 0) return;
  if (more < 0) {
    left_s_.reset();
  } else {
    shots_ += more;
    kept_s_ = worked_s_;
  }
  if (const std::optional<double> each_s = shot_s()) {
    const double left_s = *each_s * (status.frames_planned - status.frames);
    left_s_ = std::min(left_s_.value_or(left_s), left_s);
  }
}

std::optional<double> ScanPace::shot_s() const {
  return shots_ >= kEnoughShots ? std::optional(kept_s_ / shots_) : std::nullopt;
}

}  // namespace weft::app
