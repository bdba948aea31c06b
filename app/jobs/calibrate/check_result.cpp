// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/calibrate/check_result.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <array>
#include <ctime>

#include "core/files.h"

namespace weft::app {

namespace fs = std::filesystem;

Result<void> write_check_result(const fs::path& folder, const std::string& of, const Calibration& calibration,
                                const CalibrationReport& report, const std::string& checked_at) {
  if (folder.empty()) return {};
  const std::string date =
      checked_at.empty() ? fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr))) : checked_at;
  const Json result = {{"schema", fmt::format("{}/1", kCheckResultSchema)},
                       {"date", date},
                       {"of", of},
                       {"rig", calibration.subject.rig},
                       {"calibration", calibration.id},
                       {"passed", report.verdicts.empty()},
                       {"numbers", report.numbers}};
  return write_report(report, folder, std::array{NamedFile{kCheckResultFile, result.dump(2) + "\n"}});
}

double reported_delta(const fs::path& calibration) {
  const Result<Json> report = read_json(calibration / "report" / "lights.json", "weft.calibration-report", 1);
  if (!report || !report->contains("numbers") || !(*report)["numbers"].contains("delta")) return 0;
  const Json& delta = (*report)["numbers"]["delta"];
  return delta.is_number() ? delta.get<double>() : 0;
}

}  // namespace weft::app
