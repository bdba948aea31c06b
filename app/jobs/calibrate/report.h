// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/jobs/report.h"
#include "core/calibration.h"
#include "core/json_document.h"
#include "core/result.h"

// The report of one step of a calibration: what was measured, how well, and what to do where it is not well
// enough. All text is plain; it is escaped when the page is made.

namespace weft::app {

struct ReportTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct ReportPicture {
  std::string label;
  std::string svg;  ///< report/figures.h
};

struct ReportSection {
  std::string title;
  std::vector<std::string> paragraphs = {};
  std::optional<ReportTable> table = {};
  std::vector<ReportPicture> pictures = {};
  bool is_answer = false;  ///< its table is what was asked for: on the terminal, too
};

struct CalibrationReport {
  std::string part;               ///< "camera": names the files
  std::string title;              ///< "Camera of rig A, 2026-01-31"
  std::string summary;            ///< one sentence with the numbers that matter most
  std::vector<Verdict> verdicts;  ///< what is wrong or weak, the gravest first; empty: accepted
  std::vector<ReportSection> sections;
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

}  // namespace weft::app
