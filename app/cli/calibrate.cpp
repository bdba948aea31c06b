// SPDX-License-Identifier: Apache-2.0
#include "app/cli/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

// A table of a report in columns of even width.
void print_table(const report::Table& table) {
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

void print_outcome(const calibration::CalibrateOutcome& outcome, const CommonArguments& common) {
  if (common.json) {
    Json document = calibration::document_of(outcome.report);
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
  for (const report::Section& section : outcome.report.sections) {
    if (!section.is_answer || !section.table) continue;
    print("\n" + section.title);
    print_table(*section.table);
  }
}

void print_notes(const calibration::CalibrateOutcome& outcome) {
  for (const Verdict& verdict : outcome.report.verdicts) {
    note(fmt::format("{}.{}", verdict.text, verdict.remedy.empty() ? "" : " To do: " + verdict.remedy + "."));
  }
  for (const std::string& warning : outcome.warnings) note(warning);
}

Run run_work(Options& options, CalibrateWork work, ExitCode of_verdicts) {
  const auto strict = std::make_shared<bool>(false);
  options.add_flag("--strict", strict.get(), "Exit with 2 where the report has something to say");
  return [strict, work = std::move(work), of_verdicts](const CommonArguments& common) -> Result<int> {
    const Result<calibration::CalibrateOutcome> outcome = run_and_print(work, common);
    if (!outcome) return outcome.error();
    if (!outcome->report.verdicts.empty() && of_verdicts != kDone) return of_verdicts;
    const bool warned = !outcome->report.verdicts.empty() || !outcome->warnings.empty();
    return *strict && warned ? kDoneWithWarnings : kDone;
  };
}

}  // namespace

Result<calibration::CalibrateOutcome> run_and_print(const CalibrateWork& work,
                                                    const CommonArguments& common) {
  Result<calibration::CalibrateOutcome> outcome = [&] {
    ProgressLine line(common.quiet);
    return work({common.threads, stop_on_signal(), line.callback()});
  }();
  if (!outcome) return outcome;
  print_outcome(*outcome, common);
  print_notes(*outcome);
  return outcome;
}

Run run_step(Options& options, CalibrateWork work) {
  return run_work(options, std::move(work), kDone);
}

Run run_check(Options& options, CalibrateWork work) {
  return run_work(options, std::move(work), kBadDataError);
}

Verb calibrate_verb() {
  return {.name = "calibrate",
          .help = "Measure a rig; each step writes a new calibration",
          .verbs = {calibrate_camera_verb(), calibrate_response_verb(), calibrate_color_verb(),
                    calibrate_lights_verb(), calibrate_check_verb(), calibrate_accept_verb(),
                    calibrate_all_verb(), calibrate_refresh_verb(), calibrate_grey_verb(),
                    calibrate_patches_verb(), calibrate_update_verb(), calibrate_history_verb()}};
}

}  // namespace weft::app
