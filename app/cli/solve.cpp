// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/solve.h"

#include <fmt/format.h>

#include "app/cli/exit_code.h"
#include "app/cli/explain.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "core/files.h"

namespace weft::app {
namespace {

std::string status_words(const Json& status) {
  std::string words;
  for (const auto& [name, count] : status.items()) {
    if (count.get<std::int64_t>() > 0) words += fmt::format(" {} {}", name, count.get<std::int64_t>());
  }
  return words.empty() ? " none" : words;
}

// A solve of an older version says nothing of warnings.
Json warnings_of(const SolveReport& report) {
  return report.document.value("warnings", Json::array());
}

Json json_of(const SolveReport& report) {
  const Json& d = report.document;
  return {{"normal", (report.folder / "normal.exr").string()},
          {"albedo", (report.folder / "albedo.exr").string()},
          {"folder", report.folder.string()},
          {"id", d["id"]},
          {"was_there", report.was_there},
          {"albedo_scale", d["albedo_scale"]},
          {"seconds",
           {{"read", report.seconds.read},
            {"solve", report.seconds.solve},
            {"write", report.seconds.write},
            {"pictures", report.seconds.pictures},
            {"report", report.seconds.report},
            {"sync", report.seconds.sync},
            {"total", report.seconds.total}}},
          {"peak_bytes", peak_memory_bytes()},
          {"pixels", d["pixels"]},
          {"status", d["status"]},
          {"warnings", warnings_of(report)},
          {"pictures", d["pictures"]}};
}

void print_words(const SolveReport& report) {
  const Json& d = report.document;
  if (report.was_there) {
    print(fmt::format("{} is there already: same inputs, same options", report.folder.string()));
    return;
  }
  print(report.folder.string());
  print(fmt::format("  {} of {} pixels solved from {} lights; albedo is {}", d["pixels"].get<std::int64_t>(),
                    d["width"].get<std::int64_t>() * d["height"].get<std::int64_t>(), d["lights"].get<int>(),
                    d["albedo_scale"].get<std::string>()));
  print("  pixels by status:" + status_words(d["status"]));
  const SolveSeconds& s = report.seconds;
  print(fmt::format(
      "  {:.2f} s: read {:.2f}, solve {:.2f}, write {:.2f}, pictures {:.2f}, report {:.2f}, sync {:.2f}; "
      "peak {} "
      "MB",
      s.total, s.read, s.solve, s.write, s.pictures, s.report, s.sync, peak_memory_bytes() >> 20));
  print(fmt::format("  look at {}", (report.folder / "report.html").string()));
}

}  // namespace

Result<int> run_solve(const SolveArguments& arguments, const CommonArguments& common) {
  if (!arguments.ladder.empty()) return run_ladder(arguments, common);
  if (arguments.explain) return run_explain(arguments, common);
  SolveOptions options = arguments.options;
  if (arguments.wish.is_one()) {
    Result<std::string> level = chosen_level(arguments, common);
    if (!level) return std::move(level).error();
    options.method = std::move(*level);
  }
  Result<SolveReport> report = [&] {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    const bool session = !arguments.session.folder.empty();
    return session ? solve_session(arguments.session, options, context)
                   : solve_photos(arguments.photos, options, context);
  }();
  if (!report) return std::move(report).error();
  if (arguments.session.folder.empty() && !common.quiet) {
    note("photographs are taken as " + report->document["input"]["transfer"].get<std::string>() +
         "; --transfer overrides");
  }
  if (common.json) {
    print_json(json_of(*report));
  } else {
    print_words(*report);
  }
  const Json warnings = warnings_of(*report);
  for (const Json& warning : warnings) {
    const std::string remedy = warning.value("remedy", "");
    note(fmt::format("{}.{}", warning.value("text", ""), remedy.empty() ? "" : " To do: " + remedy + "."));
  }
  const bool unsolved = report->document["status"]["NO_SOLUTION"].get<std::int64_t>() > 0;
  return common.strict && (unsolved || !warnings.empty()) ? kDoneWithWarnings : kDone;
}

}  // namespace weft::app
