// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "report/page.h"

// The report of one step of a calibration: what was measured, how well, and what to do where it is not well
// enough.

namespace weft::calibration {

/// What one step found, as a page and as numbers for programs. No verdict: the calibration is accepted.
struct CalibrationReport : report::Page {
  std::string part;  ///< "camera": names the files
  Json numbers = Json::object();
};

/// <part>.html, a page that needs no other file, and <part>.json (weft.calibration-report/1: part, title,
/// summary, verdicts, numbers).
std::vector<NamedFile> report_files(const CalibrationReport& report);

/// The name of a rig: `named`, else that of the folder that holds `input`.
std::string rig_name(const std::string& named, const std::filesystem::path& input);

/// Whether `folder` may be made: kCannotCreate where it is there, as what was measured is never overwritten.
Result<void> check_new(const std::filesystem::path& folder);

/// Makes `folder` with report_files() and `more`. It is made aside: after an error there is nothing. Errors:
/// kCannotCreate, kInputOutput.
Result<void> write_report(const CalibrationReport& report, const std::filesystem::path& folder,
                          std::span<const NamedFile> more = {});

/// The document of <part>.json.
Json document_of(const CalibrationReport& report);
/// A document as files have it. Bytes of a name that are no UTF-8 are replaced.
std::string text_of(const Json& document);

}  // namespace weft::calibration
