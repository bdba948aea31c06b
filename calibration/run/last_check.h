// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

/// The result of a check of a calibration (weft calibrate check -o FOLDER), in its folder, and its schema.
inline constexpr const char* kCheckResultFile = "result.json";
inline constexpr const char* kCheckResultSchema = "weft.calibration-check";

/// What result.json says of a check (weft.calibration-check/1).
struct CheckResult {
  std::string date;  ///< of the evidence, ISO 8601
  std::string of;    ///< "sheets" or "session"
  std::string rig, calibration;
  bool passed = false;
  Json numbers = Json::object();  ///< of its report
};
void describe(Fields& fields, CheckResult& result);
/// Reads it from a folder. kNoInput, kBadData.
Result<CheckResult> read_check_result(const std::filesystem::path& folder);

/// That normals are off by the lights' movement, as far as a check could tell.
struct CheckCost {
  std::optional<double> mean_deg = {}, worst_deg = {};
};
void describe(Fields& fields, CheckCost& cost);

/// What a check said.
struct LastCheck {
  std::filesystem::path folder;
  std::string date;  ///< ISO 8601
  bool passed = false;
  CheckCost cost;
  std::string passed_last;  ///< date of the newest one that passed; empty: none did
};

/// The newest result of a check of the calibration of this id that lies beside its folder, at most two levels
/// down. None where there is none that can be read.
std::optional<LastCheck> last_check_of(const std::filesystem::path& calibration, const std::string& id);

/// Why not to go on where that check did not pass, with the degrees at stake.
Error moved_since(const LastCheck& check, std::string remedy);
/// {"why", "degrees", "checked"}: that a person went on all the same, as a session records it.
Json accepted_moved(const LastCheck& check, const std::string& why);

}  // namespace weft::calibration
