// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stop_token>
#include <utility>

#include "app/cli/rig_owner.h"
#include "capture/rig.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// The exposure of a test shot where nobody says another one.
inline constexpr double kTestShot_us = 50'000;

/// False where somebody wants an end before.
bool wait_for(double seconds, const std::stop_token& stop);

/// The devices of a rig, open for as long as this lives, by way of its daemon where one runs. They stay open
/// where they were for somebody else.
class OpenedDevices {
 public:
  static Result<std::unique_ptr<OpenedDevices>> open(const capture::Rig& rig);
  ~OpenedDevices();
  OpenedDevices(const OpenedDevices&) = delete;
  OpenedDevices& operator=(const OpenedDevices&) = delete;

  const RigClient& client() const { return reached_.client; }
  /// Holds a LED lit; how many seconds it has to rest before, 0 once it was lit for all the time.
  /// kInterrupted.
  Result<double> hold(int led, double seconds, const std::stop_token& stop) const;
  /// A test shot by this LED (0: none) once it is taken, as GET rig/test-shots has it. The error of one that
  /// failed; kInterrupted.
  Result<Json> shoot(int led, double exposure_us, const std::stop_token& stop) const;

 private:
  OpenedDevices(ReachedRig reached, bool were_open) : reached_(std::move(reached)), were_open_(were_open) {}

  ReachedRig reached_;
  bool were_open_;
};

}  // namespace weft::app
