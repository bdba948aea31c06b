// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/checks/rig_movement.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

/// What becomes different where a rig scans by one calibration in the place of another.
struct CalibrationChange {
  /// The error of maps, as far as both calibrations know camera and near lights: the old one's if the new one
  /// is right.
  std::optional<MovementCost> maps;
  std::vector<std::string> gained, lost;  ///< parts that only one of them has: "camera", "color"
  std::string old_id, new_id;
  std::string warning;  ///< that nobody checked the new one, or that it did not pass; empty: it did
};

/// "camera", "response", "lights", "color", those that there are.
std::vector<std::string> parts_of(const Calibration& calibration);

/// `from` is the folder of the rig's calibration; empty: it had none. kBadData where the new one has no
/// camera, response and lights, or is of another body, aperture or size.
Result<CalibrationChange> change_between(const std::filesystem::path& from, const std::filesystem::path& to);

/// {"from", "to", "maps", "gained", "lost", "warning"}.
Json json_of(const CalibrationChange& change);
/// A few lines for people.
std::vector<std::string> words_of(const CalibrationChange& change);

/// Has the rig file name another calibration: its one line, the others stay as they are. kBadData where the
/// file then would not be read as meant; it is as it was then.
Result<void> name_calibration(const std::filesystem::path& rig_file,
                              const std::filesystem::path& calibration);

}  // namespace weft::calibration
