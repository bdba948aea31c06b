// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/rig_watch.h"

#include <utility>

#include "core/rig/session.h"

namespace weft::app {

namespace fs = std::filesystem;

RigWatch::RigWatch(capture::Rig rig, std::function<void()> told)
    : rig_(std::move(rig)), told_(std::move(told)) {
  if (const fs::path last = calibration::looked_at_last(rig_.scan.sessions); !last.empty()) look_at(last);
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

void RigWatch::saw(const fs::path& session) {
  const std::lock_guard lock(mutex_);
  to_see_.push_back(session);
  woken_.notify_all();
}

void RigWatch::hold_against_calibration() {
  saw({});
}

void RigWatch::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void RigWatch::work(const std::stop_token& stop) {
  for (;;) {
    fs::path session;
    {
      std::unique_lock lock(mutex_);
      if (!woken_.wait(lock, stop, [this] { return !to_see_.empty(); })) return;
      session = std::move(to_see_.front());
      to_see_.pop_front();
    }
    look_at(session);
    if (stop.stop_requested()) return;
    told_();
  }
}

void RigWatch::look_at(const fs::path& folder) {
  std::optional<calibration::RigLook> look;
  if (folder.empty()) {
    const std::lock_guard lock(mutex_);
    look = seen_;
  } else if (const Result<Session> session = read_session(folder)) {
    look = calibration::kept_look(*session);
  }
  if (!look) return;
  look = calibration::look_by_now(std::move(*look), capture::calibration_now(rig_));
  const std::lock_guard lock(mutex_);
  if (!folder.empty()) session_ = folder.stem().string();
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
