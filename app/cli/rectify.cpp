// SPDX-License-Identifier: Apache-2.0
#include "material/run/rectify.h"

#include <fmt/format.h>

#include <memory>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "material/run/session_sets.h"
#include "solve/session/solved.h"

namespace weft::app {
namespace {

Result<int> rectify(material::RectifyOptions& options, const CommonArguments& common) {
  if (Result<void> ok = solve::keep_pixel(options.session, options.mm_per_pixel); !ok)
    return std::move(ok).error();
  const Result<material::RectifyReport> report = [&] {
    ProgressLine line(common.quiet);
    return material::rectify_session(options, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!report) return report.error();
  if (common.json) {
    print_product(json_of(report->facts), report->folder, report->was_there);
    return kDone;
  }
  const material::RectifyFacts& facts = report->facts;
  print(report->folder.string());
  for (const std::string& line : material::source_lines(facts.source)) print("  " + line);
  print(report->was_there ? "  is there already: same solve, same options"
                          : fmt::format("  {} x {} pixels of {:.5g} mm", facts.size.width, facts.size.height,
                                        facts.mm_per_pixel));
  return kDone;
}

Run add_rectify(Options& options) {
  const auto a = std::make_shared<material::RectifyOptions>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return rectify(*a, common); };
}

}  // namespace

Verb rectify_verb() {
  return {"rectify", "Put the maps of a solve on a square grid of the table, lens removed", add_rectify};
}

}  // namespace weft::app
