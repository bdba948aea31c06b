// SPDX-License-Identifier: Apache-2.0
#include "library/chain/make.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"

namespace weft::app {
namespace {

Json json_of(const library::MakeReport& report) {
  Json made = Json::array();
  for (const library::MadeLink& link : report.made) {
    made.push_back(
        {{"name", link.name}, {"id", link.id}, {"folder", link.folder.string()}, {"seconds", link.seconds}});
  }
  return {{"steps", report.steps}, {"made", std::move(made)}, {"chain", json_of(report.chain)}};
}

void print_words(const library::MakeReport& report, bool only_explains) {
  print(report.chain.session);
  if (report.steps.empty()) print("  all of it is fresh: nothing to make");
  if (only_explains) {
    for (const std::string& step : report.steps) print("  would " + step);
    return;
  }
  for (const library::MadeLink& link : report.made)
    print(fmt::format("  made {} in {:.2f} s: {}", link.name, link.seconds, link.folder.string()));
  print("  " + words_of(report.chain.verdict));
  for (const library::ChainLink& link : report.chain.links)
    print(fmt::format("  {:12} {}", link.name, words_of(link)));
}

Result<int> make(const library::MakeOptions& options, const CommonArguments& common) {
  const Result<library::MakeReport> report = [&] {
    ProgressLine line(common.quiet);
    return library::make_session(options, {common.threads, stop_on_signal(), line.callback()},
                                 options.only_explains ? library::TellStep() : line.teller());
  }();
  if (!report) return report.error();
  if (common.json) {
    print_json(json_of(*report));
  } else {
    print_words(*report, options.only_explains);
  }
  return kDone;
}

Run add_make(Options& options) {
  const auto a = std::make_shared<library::MakeOptions>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return make(*a, common); };
}

}  // namespace

Verb make_verb() {
  return {"make", "Make what a session lacks or has stale: its solve, maps and exports", add_make};
}

}  // namespace weft::app
