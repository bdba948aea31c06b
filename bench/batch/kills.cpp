// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <random>

#include "app/jobs/batch/merge_batch.h"
#include "bench/batch/archive.h"
#include "bench/batch/studies.h"
#include "core/files.h"
#include "core/process.h"
#include "core/solve.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

struct Killed {
  int kills = 0, runs = 0;
};

// Runs the plan again and again, killed after some time, until it ends by itself.
Result<Killed> run_and_kill(const fs::path& plan, const fs::path& log, int most_kills) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> wait_s(0.3, 1.5);
  Killed killed;
  while (true) {
    const auto child =
        ChildProcess::start({program_beside("weft").string(), "batch", "run", plan.string(), "-q"}, {}, log);
    if (!child) return child.error();
    ++killed.runs;
    const std::optional<int> code = (*child)->wait(killed.kills < most_kills ? wait_s(random) : 3600);
    if (code == 0) return killed;
    if (code)
      return Error{ErrorKind::kInternal, fmt::format("weft batch run ended with {}", *code), log.string(), "",
                   ""};
    (*child)->signal(SIGKILL);
    (*child)->wait(10);
    ++killed.kills;
  }
}

int half_made_in(const fs::path& archive) {
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(archive)) {
    if (entry.path().extension() == ".partial") ++count;
  }
  return count;
}

}  // namespace

Result<Rows> batch_kills(const StudyOptions& options, int kills) {
  const int sessions = options.runs;
  const TemporaryFolder folder;
  const fs::path archive = folder.path() / "archive", plan = folder.path() / "plan.jsonl",
                 log = folder.path() / "log";
  if (Result<void> made = make_archive(archive, options.scene, options.megapixels, sessions, 4); !made)
    return made.error();
  const Result<int> planned =
      run_program({"batch", "plan", archive.string(), "-o", plan.string(), "--sample", "1", "-q"}, log);
  if (!planned) return planned.error();
  const Result<Killed> killed = run_and_kill(plan, log, kills);
  if (!killed) return killed.error();
  const int half_made = half_made_in(archive);
  const Result<app::MergeReport> merged = app::merge_batch(plan, {});
  if (!merged) return merged.error();
  int once = 0;
  for (const batch::Row& row : merged->state.rows) {
    if (list_solves(row.job->session).size() == 1) ++once;
  }
  const batch::Summary& summary = merged->state.summary;
  return Rows{{{"sessions", sessions},
               {"kills", killed->kills},
               {"published_once", once},
               {"failed", summary.failed},
               {"missing", summary.missing},
               {"half_made_before_merge", half_made},
               {"half_made_after", half_made_in(archive)}}};
}

}  // namespace weft::bench
