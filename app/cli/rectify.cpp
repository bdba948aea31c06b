// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/rectify.h"

#include <fmt/format.h>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"

namespace weft::app {

Result<int> run_rectify(const RectifyOptions& options, const CommonArguments& common) {
  const Result<RectifyReport> report = [&] {
    ProgressLine line(common.quiet);
    return rectify_session(options, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!report) return report.error();
  if (common.json) {
    Json document = report->document;
    document["folder"] = report->folder.string();
    document["was_there"] = report->was_there;
    print_json(document);
    return kDone;
  }
  const Json& d = report->document;
  print(report->folder.string());
  print(report->was_there ? "  is there already: same solve, same options"
                          : fmt::format("  {} x {} pixels of {:.5g} mm", d["width"].get<int>(),
                                        d["height"].get<int>(), d["mm_per_pixel"].get<double>()));
  return kDone;
}

}  // namespace weft::app
