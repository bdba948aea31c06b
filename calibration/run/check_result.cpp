// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/check_result.h"

#include <fmt/format.h>

#include <array>

#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/describe/field_json.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

/// The numbers of the report of a calibration's lights; empty where there is none.
Json lights_numbers(const fs::path& calibration) {
  const Result<Json> report = read_json(calibration / "report" / "lights.json", "weft.calibration-report", 1);
  if (!report || !report->contains("numbers") || !(*report)["numbers"].is_object()) return Json::object();
  return (*report)["numbers"];
}

}  // namespace

Result<void> write_check_result(const fs::path& folder, const std::string& of, const Calibration& calibration,
                                const CalibrationReport& report, const std::string& checked_at) {
  if (folder.empty()) return {};
  const std::string date = checked_at.empty() ? iso_time_now() : checked_at;
  Json result = {{"schema", fmt::format("{}/1", kCheckResultSchema)}};
  write_fields(result, CheckResult{date, of, calibration.subject.rig, calibration.id, report.verdicts.empty(),
                                   report.numbers});
  return write_report(report, folder, std::array{NamedFile{kCheckResultFile, text_of(result)}});
}

double reported_delta(const fs::path& calibration) {
  const Json numbers = lights_numbers(calibration);
  return numbers.contains("delta") && numbers["delta"].is_number() ? numbers["delta"].get<double>() : 0;
}

std::set<std::string> fitted_sha256(const fs::path& calibration) {
  std::set<std::string> digests;
  const Json numbers = lights_numbers(calibration);
  if (!numbers.contains("fitted")) return digests;
  for (const Json& session : numbers["fitted"]) {
    if (!session.is_object() || !session.contains("lit_sha256")) continue;
    for (const Json& digest : session["lit_sha256"]) {
      if (digest.is_string()) digests.insert(digest.get<std::string>());
    }
  }
  return digests;
}

}  // namespace weft::calibration
