// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/rig_watch.h"

#include <utility>

#include "core/rig/session.h"

namespace weft::app {

namespace fs = std::filesystem;

RigWatch::RigWatch(capture::Rig rig) : rig_(std::move(rig)) {
  if (const fs::path last = calibration::looked_at_last(rig_.scan.sessions); !last.empty()) saw(last);
}

void RigWatch::saw(const fs::path& folder) {
  const Result<Session> session = read_session(folder);
  if (!session) return;
  if (std::optional<calibration::RigLook> look = calibration::kept_look(*session))
    take(folder.stem().string(), std::move(*look));
}

void RigWatch::hold_against_calibration() {
  std::optional<calibration::RigLook> seen;
  std::string session;
  {
    const std::lock_guard lock(mutex_);
    seen = seen_;
    session = session_;
  }
  if (seen) take(session, std::move(*seen));
}

void RigWatch::take(const std::string& session, calibration::RigLook look) {
  look = calibration::look_by_now(std::move(look), capture::calibration_now(rig_));
  const std::lock_guard lock(mutex_);
  session_ = session;
  seen_ = std::move(look);
}

Json RigWatch::place() const {
  const std::lock_guard lock(mutex_);
  if (!seen_) return {};
  return {{"state", kRigPlaceNames[static_cast<std::size_t>(seen_->state)]},
          {"says", seen_->says},
          {"action", seen_->action},
          {"cost_mean_deg", seen_->cost.mean_deg},
          {"session", session_},
          {"taken", seen_->taken}};
}

}  // namespace weft::app
