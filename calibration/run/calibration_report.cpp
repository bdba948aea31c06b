// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibration_report.h"

#include "core/base/files.h"

namespace weft::calibration {

namespace fs = std::filesystem;

Json document_of(const CalibrationReport& report) {
  return {{"schema", "weft.calibration-report/1"},
          {"part", report.part},
          {"title", report.title},
          {"summary", report.summary},
          {"verdicts", json_of(report.verdicts)},
          {"numbers", report.numbers}};
}

std::string text_of(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::vector<NamedFile> report_files(const CalibrationReport& report) {
  return {{report.part + ".html", html_of(report)}, {report.part + ".json", text_of(document_of(report))}};
}

std::string rig_name(const std::string& named, const fs::path& input) {
  return named.empty() ? absolute_folder(input).parent_path().filename().string() : named;
}

Result<void> check_new(const fs::path& folder) {
  if (folder.empty() || !is_there(folder)) return {};
  return Error{ErrorKind::kCannotCreate, "there is something already", folder.string(),
               "what was measured is never overwritten", "name a new folder with -o"};
}

Result<void> write_report(const CalibrationReport& report, const fs::path& folder,
                          std::span<const NamedFile> more) {
  if (Result<void> ok = check_new(folder); !ok) return ok;
  PartialFolder partial(folder);
  if (Result<void> ok = make_writable_folder(partial.path()); !ok) return ok;
  std::vector<NamedFile> files = report_files(report);
  files.insert(files.end(), more.begin(), more.end());
  for (const NamedFile& file : files) {
    if (Result<void> ok = write_file(partial.path() / file.name, file.bytes); !ok) return ok;
  }
  return partial.publish();
}

}  // namespace weft::calibration
