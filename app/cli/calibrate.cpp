// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "core/files.h"

namespace weft::app {
namespace {

Result<CalibrateOutcome> run_step(const CalibrateCameraOptions& options, const JobContext& context) {
  return calibrate_camera(options, context);
}
Result<CalibrateOutcome> run_step(const CalibrateResponseOptions& options, const JobContext& context) {
  return calibrate_response(options, context);
}
Result<CalibrateOutcome> run_step(const CalibrateColorOptions& options, const JobContext& context) {
  return calibrate_color(options, context);
}

Result<CalibrateOutcome> run_step(const CalibrateLightsOptions& options, const JobContext& context) {
  return calibrate_lights(options, context);
}
Result<CalibrateOutcome> run_step(const CalibrateCheckOptions& options, const JobContext& context) {
  if (options.input.empty()) {
    return Error{ErrorKind::kUsage, "nothing to check", "weft calibrate check", "neither input nor --session",
                 "name a session of a sheet, a folder of them, or a scan by --session"};
  }
  return calibrate_check(options, context);
}
Result<CalibrateOutcome> run_step(const CheckRigOptions& options, const JobContext& context) {
  return calibrate_check_rig(options, context);
}
Result<CalibrateOutcome> run_step(const CalibratePatchesOptions& options, const JobContext& context) {
  return calibrate_patches(options, context);
}
Result<CalibrateOutcome> run_step(const CalibrateGreyOptions& options, const JobContext& context) {
  return calibrate_grey(options, context);
}
Result<CalibrateOutcome> run_step(const CalibrateUpdateOptions& options, const JobContext& context) {
  return calibrate_update(options, context);
}
Result<CalibrateOutcome> run_step(const CalibrateHistoryOptions& options, const JobContext& context) {
  Result<CalibrationHistory> history = calibrate_history(options, context);
  if (!history) return std::move(history).error();
  return CalibrateOutcome{options.output, {}, std::move(history->report), std::move(history->warnings)};
}

// A table of a report in columns of even width.
void print_table(const ReportTable& table) {
  std::vector<std::size_t> width(table.header.size(), 0);
  const auto measure = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < std::min(row.size(), width.size()); ++i) {
      width[i] = std::max(width[i], row[i].size());
    }
  };
  const auto print_row = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < std::min(row.size(), width.size()); ++i) {
      line += fmt::format("  {:<{}}", row[i], width[i]);
    }
    print(line);
  };
  measure(table.header);
  for (const auto& row : table.rows) measure(row);
  print_row(table.header);
  for (const auto& row : table.rows) print_row(row);
}

void print_outcome(const CalibrateOutcome& outcome, const CommonArguments& common) {
  if (common.json) {
    Json document = document_of(outcome.report);
    document["folder"] = outcome.folder.string();
    document["id"] = outcome.calibration.id;
    document["warnings"] = outcome.warnings;
    print_json(document);
    return;
  }
  if (!outcome.folder.empty()) print(outcome.folder.string());
  print("  " + outcome.report.summary);
  if (!outcome.folder.empty()) {
    const std::filesystem::path reports = outcome.folder / "report";
    print(fmt::format(
        "  look at {}",
        ((is_there(reports) ? reports : outcome.folder) / (outcome.report.part + ".html")).string()));
  }
  for (const ReportSection& section : outcome.report.sections) {
    if (!section.is_answer || !section.table) continue;
    print("\n" + section.title);
    print_table(*section.table);
  }
}

}  // namespace

Result<int> run_calibrate(const CalibrateArguments& arguments, const CommonArguments& common) {
  const Result<CalibrateOutcome> outcome = [&] {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    return std::visit([&](const auto& options) { return run_step(options, context); }, arguments);
  }();
  if (!outcome) return outcome.error();
  print_outcome(*outcome, common);
  for (const Verdict& verdict : outcome->report.verdicts) {
    note(fmt::format("{}.{}", verdict.text, verdict.remedy.empty() ? "" : " To do: " + verdict.remedy + "."));
  }
  for (const std::string& warning : outcome->warnings) note(warning);
  const bool is_check = std::holds_alternative<CalibrateCheckOptions>(arguments) ||
                        std::holds_alternative<CheckRigOptions>(arguments);
  if (is_check && !outcome->report.verdicts.empty()) return kBadDataError;  // its answer is no
  const bool warned = !outcome->report.verdicts.empty() || !outcome->warnings.empty();
  return common.strict && warned ? kDoneWithWarnings : kDone;
}

}  // namespace weft::app
