// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "calibration/run/calibration_report.h"
#include "calibration/run/last_check.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

/// Writes a result folder aside and renames it: result.json and the files of the report. Nothing where
/// `folder` is empty. `of` is "sheets" or "session". `checked_at` is when the evidence was taken, else now
/// (ISO 8601). Errors: kCannotCreate where it is there.
Result<void> write_check_result(const std::filesystem::path& folder, const std::string& of,
                                const Calibration& calibration, const CalibrationReport& report,
                                const std::string& checked_at);

/// What `calibrate lights` found the paper to be, if its report is in a calibration's folder; else 0.
double reported_delta(const std::filesystem::path& calibration);

/// SHA-256 of the lit frames that `calibrate lights` fitted, by the same report; none where it is not there.
std::set<std::string> fitted_sha256(const std::filesystem::path& calibration);

/// How flat sheets were turned that a calibration rests on (turn_deg()), by the reports of its lights and of
/// its last update; none where neither says.
std::vector<double> fitted_turns_deg(const std::filesystem::path& calibration);

}  // namespace weft::calibration
