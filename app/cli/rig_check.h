// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "app/cli/options.h"
#include "app/cli/verb.h"
#include "calibration/run/rig_look.h"
#include "capture/rig.h"

namespace weft::app {

/// `weft rig check`: whether the rig moved since it was calibrated, by what scans show of it.
Run add_rig_check(Options& options);

/// What its last scan shows of a rig, against the calibration that it has now; nothing where none was looked
/// at.
struct SeenRig {
  std::string session;  ///< its name
  calibration::RigLook look;
};
std::optional<SeenRig> last_seen(const capture::Rig& rig);

}  // namespace weft::app
