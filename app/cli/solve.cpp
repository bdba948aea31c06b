// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/solve.h"

#include <fmt/format.h>

#include "app/cli/exit_code.h"
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
            {"sync", report.seconds.sync},
            {"total", report.seconds.total}}},
          {"peak_bytes", peak_memory_bytes()},
          {"pixels", d["pixels"]},
          {"status", d["status"]},
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
      "  {:.2f} s: read {:.2f}, solve {:.2f}, write {:.2f}, pictures {:.2f}, sync {:.2f}; peak {} MB",
      s.total, s.read, s.solve, s.write, s.pictures, s.sync, peak_memory_bytes() >> 20));
  for (const Json& name : d["pictures"]) {
    if (name == "sheet.png") print(fmt::format("  look at {}", (report.folder / "sheet.png").string()));
  }
}

}  // namespace

Result<int> run_solve(const SolveArguments& arguments, const CommonArguments& common) {
  Result<SolveReport> report = [&] {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    const bool session = !arguments.session.folder.empty();
    return session ? solve_session(arguments.session, arguments.options, context)
                   : solve_photos(arguments.photos, arguments.options, context);
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
  const bool unsolved = report->document["status"]["NO_SOLUTION"].get<std::int64_t>() > 0;
  return common.strict && unsolved ? kDoneWithWarnings : kDone;
}

}  // namespace weft::app
