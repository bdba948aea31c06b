// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace weft::app {

/// The result of a check of a calibration (weft calibrate check -o FOLDER), in its folder, and its schema.
inline constexpr const char* kCheckResultFile = "result.json";
inline constexpr const char* kCheckResultSchema = "weft.calibration-check";

/// What a check said.
struct LastCheck {
  std::filesystem::path folder;
  std::string date;  ///< ISO 8601
  bool passed = false;
  std::optional<double> mean_deg, worst_deg;  ///< that normals are off, as far as it could tell
};

/// The newest result of a check of the calibration of this id that lies beside its folder, at most two levels
/// down. None where there is none that can be read.
std::optional<LastCheck> last_check_of(const std::filesystem::path& calibration, const std::string& id);

}  // namespace weft::app
