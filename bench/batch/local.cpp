// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "app/jobs/solve.h"
#include "bench/batch/archive.h"
#include "bench/batch/studies.h"
#include "core/files.h"
#include "core/job.h"
#include "core/parallel.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

// One process that solves them one after the other with all threads.
Result<double> solve_in_turn(const fs::path& archive, const fs::path& output, int sessions, int threads) {
  Stopwatch watch;
  for (int i = 0; i < sessions; ++i) {
    app::SolveOptions options;
    options.output = output / std::to_string(i);
    const Result<app::SolveReport> solved = app::solve_session(
        {.folder = session_in(archive, i), .calibration = {}, .leds = {}}, options, {threads});
    if (!solved) return solved.error();
  }
  return watch.lap();
}

}  // namespace

Result<Rows> batch_local(const StudyOptions& options, int jobs) {
  const int sessions = options.runs;
  const int threads = resolved_threads(options.threads);
  const TemporaryFolder folder;
  const fs::path archive = folder.path() / "archive", log = folder.path() / "log",
                 plan = folder.path() / "plan.jsonl";
  if (Result<void> made = make_archive(archive, options.scene, options.megapixels, sessions, 4); !made)
    return made.error();
  const Result<double> in_turn = solve_in_turn(archive, folder.path() / "in-turn", sessions, threads);
  if (!in_turn) return in_turn.error();
  std::error_code ignored;
  fs::remove_all(folder.path() / "in-turn", ignored);

  const std::string cores = std::to_string(threads);
  Result<int> code =
      run_program({"batch", "plan", archive.string(), "-o", plan.string(), "--sample", "8", "--output",
                   (folder.path() / "solves").string(), "--threads", cores, "--json", "-q"},
                  log);
  if (!code) return code.error();
  if (*code != 0) return ended_with("plan", *code, log);
  const Json planned = Json::parse(*read_text(log), nullptr, false);
  Stopwatch watch;
  code = run_program(
      {"batch", "run", plan.string(), "-q", "--jobs", std::to_string(jobs), "--threads", cores}, log);
  const double batch_s = watch.lap();
  if (!code) return code.error();
  if (*code != 0) return ended_with("run", *code, log);
  const double predicted_s = 3600 * planned["hours"].get<double>();
  return Rows{{{"sessions", sessions},
               {"megapixels", options.megapixels},
               {"threads", threads},
               {"jobs", jobs},
               {"in_turn_s", *in_turn},
               {"batch_s", batch_s},
               {"ratio", batch_s / *in_turn},
               {"predicted_s", predicted_s},
               {"off_by", predicted_s / batch_s - 1}}};
}

}  // namespace weft::bench
