// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/program/studies.h"
#include "bench/server/wide_solve.h"
#include "core/base/files.h"
#include "core/base/process.h"
#include "core/base/temporary_folder.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScript = "tests/web/bench/page.mjs";
constexpr double kPatience_s = 1800;

struct PageArguments {
  std::vector<int> megapixels = {16, 100};
  int minutes = 0;  ///< of panning
};

/// A browser looks at a solve of each size, and at the desk of a virtual rig.
Result<Rows> measure(const PageArguments& a, const StudyOptions& options) {
  if (!is_there(kScript)) {
    return Error{ErrorKind::kNoInput, "the page cannot be measured here", kScript,
                 "the scripts for the browser are not in this folder",
                 "run it in a clone of weft: ./dev bench page"};
  }
  const TemporaryFolder scratch;
  std::vector<std::string> command = {"/usr/bin/env", "node", kScript};
  for (const int megapixels : a.megapixels) {
    const fs::path sessions = scratch.path() / std::to_string(megapixels);
    if (Result<void> ok = write_wide_solve(sessions, wide_size(megapixels)); !ok)
      return std::move(ok).error();
    command.push_back(sessions.string());
  }
  options.progress(0, 1);
  const fs::path said = scratch.path() / "rows.json";
  const auto browser = ChildProcess::start(
      command, {"WEFT_PROGRAMS=" + options.programs.string(), "WEFT_MINUTES=" + std::to_string(a.minutes)},
      said);
  if (!browser) return browser.error();
  const std::optional<int> code =
      (*browser)->wait(kPatience_s + 60.0 * a.minutes * static_cast<double>(a.megapixels.size()));
  const Json rows = Json::parse((*browser)->said(), nullptr, false);
  if (code == 0 && rows.is_array()) return Rows(rows.begin(), rows.end());
  return Error{ErrorKind::kTryAgain, "the browser ended otherwise than it should", kScript,
               (*browser)->said().substr(0, 2000),
               "npm ci --prefix tests/web, and chromium-headless-shell, are needed"};
}

app::Run add_page(app::Options& options) {
  const auto a = std::make_shared<PageArguments>();
  options.add("--megapixels", &a->megapixels, "Sizes of the maps that are looked at")
      .by_commas()
      .in_range(1, 200)
      .shows_default();
  options.add("--minutes", &a->minutes, "Also pan over each of them for so long: memory by the minute")
      .in_range(0, 600)
      .shows_default();
  return run_of(
      by_flag(options, {{"browser", "", [a](const StudyOptions& asked) { return measure(*a, asked); }}}));
}

}  // namespace

app::Verb page_verb() {
  return {"page", "The page in a browser: how long a person waits for it", add_page};
}

}  // namespace weft::bench
