// SPDX-License-Identifier: Apache-2.0
#include "bench/program/studies.h"

#include <algorithm>
#include <utility>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"

namespace weft::bench {
namespace {

const Study& chosen_of(const StudyChoice& choice) {
  for (std::size_t i = 0; i < choice.studies.size(); ++i) {
    if (choice.part == choice.studies[i].name || (!choice.by_flag.empty() && choice.by_flag[i]))
      return choice.studies[i];
  }
  return choice.studies.front();
}

Result<Rows> measure(const Study& study, StudyOptions options, bool quiet) {
  if (options.megapixels == 0) options.megapixels = study.own.megapixels;
  if (options.runs == 0) options.runs = study.own.runs;
  app::ProgressLine line(quiet);
  options.progress = [&](int done, int of) { line.update(study.name, static_cast<double>(done) / of); };
  return study.measure(options);
}

}  // namespace

Choice by_part(app::Options& options, std::vector<Study> studies) {
  const auto choice = std::make_shared<StudyChoice>();
  choice->studies = std::move(studies);
  choice->part = choice->studies.front().name;
  std::vector<std::string> names;
  std::string help = "Which table:";
  for (const Study& study : choice->studies) {
    help += std::string(names.empty() ? "" : ";") + " " + study.name + ", " + study.what;
    names.push_back(study.name);
  }
  options.add("--part", &choice->part, help).one_of(names).shows_default();
  return choice;
}

Choice by_flag(app::Options& options, std::vector<Study> studies, std::vector<app::Option>* instead) {
  const auto choice = std::make_shared<StudyChoice>();
  choice->studies = std::move(studies);
  choice->by_flag.resize(choice->studies.size());
  for (std::size_t i = 1; i < choice->studies.size(); ++i) {
    const Study& study = choice->studies[i];
    instead->push_back(options.add_flag("--" + study.name, &choice->by_flag[i], study.what));
  }
  return choice;
}

void exclude_each_other(const std::vector<app::Option>& options) {
  for (std::size_t i = 0; i < options.size(); ++i) {
    for (std::size_t j = i + 1; j < options.size(); ++j) options[i].excludes(options[j]);
  }
}

app::Run run_of(const Choice& choice) {
  return [choice](const app::CommonArguments& common) -> Result<int> {
    choice->options.threads = common.threads;
    const Result<Rows> rows = measure(chosen_of(*choice), choice->options, common.quiet);
    if (!rows) return rows.error();
    if (common.json) {
      app::print_json(document_of(*rows));
    } else {
      app::print(table_of(*rows));
    }
    return app::kDone;
  };
}

}  // namespace weft::bench
