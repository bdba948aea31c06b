// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/check_result.h"

#include <fmt/format.h>

#include <array>

#include "calibration/checks/flatness.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/describe/field_json.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLightsReport = "lights.json";

/// The numbers of a report of a calibration; empty where there is none.
Json numbers_in(const fs::path& calibration, const char* name) {
  const Result<Json> report = read_json(calibration / "report" / name, "weft.calibration-report", 1);
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
  const Json numbers = numbers_in(calibration, kLightsReport);
  return numbers.contains("delta") && numbers["delta"].is_number() ? numbers["delta"].get<double>() : 0;
}

std::set<std::string> fitted_sha256(const fs::path& calibration) {
  std::set<std::string> digests;
  const Json numbers = numbers_in(calibration, kLightsReport);
  if (!numbers.contains("fitted")) return digests;
  for (const Json& session : numbers["fitted"]) {
    if (!session.is_object() || !session.contains("lit_sha256")) continue;
    for (const Json& digest : session["lit_sha256"]) {
      if (digest.is_string()) digests.insert(digest.get<std::string>());
    }
  }
  return digests;
}

std::vector<double> fitted_turns_deg(const fs::path& calibration) {
  std::vector<double> turns_deg;
  for (const char* report : {kLightsReport, "update.json"}) {
    for (const Json& sheet : numbers_in(calibration, report).value("sheets", Json::array())) {
      if (!sheet.is_object()) continue;
      const Json tilt = sheet.value("tilt_deg", Json()), turn = sheet.value("turn_deg", Json());
      if (tilt.is_number() && turn.is_number() && tilt.get<double>() < kTiltedFrom_deg)
        turns_deg.push_back(turn.get<double>());
    }
  }
  return turns_deg;
}

}  // namespace weft::calibration
