// SPDX-License-Identifier: Apache-2.0
#include "bench/batch/batch_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "bench/batch/archive.h"
#include "core/base/files.h"
#include "core/base/job_context.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "core/rig/calibration.h"
#include "core/solve/solve.h"
#include "library/batch/outcome.h"
#include "library/batch/plan.h"
#include "library/run/batch_page.h"
#include "library/run/merge_batch.h"
#include "library/run/plan_file.h"
#include "simulator/scene/scene.h"
#include "solve/run/solve_session.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

// One process that solves them one after the other with all threads.
Result<double> solve_in_turn(const fs::path& archive, const fs::path& output, int sessions, int threads) {
  Stopwatch watch;
  for (int i = 0; i < sessions; ++i) {
    solve::SolveOptions options;
    options.output = output / std::to_string(i);
    const Result<solve::SolveReport> solved = solve::solve_session(
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
  const fs::path archive = folder.path() / "archive", plan = folder.path() / "plan.jsonl";
  if (Result<void> made = make_archive(archive, options.scene, options.megapixels, sessions, 4); !made)
    return made.error();
  const Result<double> in_turn = solve_in_turn(archive, folder.path() / "in-turn", sessions, threads);
  if (!in_turn) return in_turn.error();
  std::error_code ignored;
  fs::remove_all(folder.path() / "in-turn", ignored);

  const std::string cores = std::to_string(threads);
  const Result<std::string> planned =
      run_weft({"batch", "plan", archive.string(), "-o", plan.string(), "--sample", "8", "--output",
                (folder.path() / "solves").string(), "--threads", cores, "--json", "-q"});
  if (!planned) return planned.error();
  Stopwatch watch;
  const Result<std::string> ran =
      run_weft({"batch", "run", plan.string(), "-q", "--jobs", std::to_string(jobs), "--threads", cores});
  const double batch_s = watch.lap();
  if (!ran) return ran.error();
  const double predicted_s = 3600 * Json::parse(*planned)["hours"].get<double>();
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

namespace {

constexpr int kOwn = 10, kSample = 10;

library::TaskOutcome outcome_of(const library::BatchPlan& plan, const library::PlannedSolve& planned,
                                int number) {
  library::TaskOutcome outcome;
  outcome.plan = plan.header.id;
  outcome.session = planned.session;
  outcome.state = library::TaskState::kSolved;
  outcome.solve = planned.solve;
  outcome.folder = library::solve_parent(plan.header, planned.session) + "/" + planned.solve;
  outcome.seconds = outcome.node_seconds = 5;
  outcome.sigma_deg = 0.6;
  outcome.left_out = 0.03 + 1e-6 * number;
  library::MapChange change;
  change.pixels = 16'000'000;
  change.mean_deg = 0.1 + 1e-5 * number;
  change.p95_deg = 2 * change.mean_deg;
  change.max_deg = 9;
  change.sigma_deg = {0.6, 0.6};
  outcome.change = change;
  return outcome;
}

}  // namespace

Result<Rows> batch_plan(const StudyOptions& options) {
  const int sessions = options.runs;
  const TemporaryFolder folder;
  const fs::path archive = folder.path() / "archive";
  if (Result<void> made = make_archive(archive, options.scene, options.megapixels, sessions, kOwn); !made)
    return made.error();
  Stopwatch watch;
  const Result<std::string> said =
      run_weft({"batch", "plan", archive.string(), "-o", (folder.path() / "plan.jsonl").string(), "--sample",
                std::to_string(kSample), "--json", "-q", "--threads", std::to_string(options.threads)});
  const double wall_s = watch.lap();
  if (!said) return said.error();
  const Json planned = Json::parse(*said);
  const double sample_s = planned["sample_seconds"].get<double>();
  return Rows{{{"sessions", planned["sessions"]},
               {"tasks", planned["tasks"]},
               {"plan_s", wall_s - sample_s},
               {"asked_s", 60},
               {"sample", planned["sampled"]},
               {"sample_s", sample_s}}};
}

Result<Rows> batch_merge(const StudyOptions& options) {
  const int sessions = options.runs;
  const TemporaryFolder folder;
  const fs::path archive = folder.path() / "archive", file = folder.path() / "plan.jsonl";
  library::BatchPlan plan;
  plan.header.archive = archive.string();
  for (int i = 0; i < sessions; ++i) {
    library::PlannedSolve planned;
    planned.session = session_in(archive, i).string();
    planned.digest = std::string(64, 'a');
    planned.quality = "standard";
    planned.solve = fmt::format("{:016x}", i);
    planned.before = "before";
    planned.rig = fmt::format("rig {}", i % 3);
    planned.calibration = fmt::format("calibration {}", i % 3);
    planned.megapixels = 16;
    planned.forecast.seconds = 6;
    plan.solves.push_back(std::move(planned));
  }
  library::share_out(plan.solves, 600);
  if (const Result<void> written = library::write_plan(file, library::text_of(plan)); !written)
    return written.error();
  const Result<library::PlanFile> opened = library::open_plan(file);
  if (!opened) return opened.error();
  fs::create_directories(opened->results());
  for (int i = 0; i < sessions; ++i) {
    const library::PlannedSolve& planned = plan.solves[static_cast<std::size_t>(i)];
    const library::TaskOutcome outcome = outcome_of(plan, planned, i);
    fs::create_directories(outcome.folder);
    std::ofstream(fs::path(outcome.folder) / "solve.json") << "{}";
    std::ofstream(opened->results_of(planned.task), std::ios::app) << library::line_of(outcome);
  }
  Stopwatch watch;
  const Result<std::string> merged = run_weft({"batch", "merge", file.string(), "-q"});
  const double merge_s = watch.lap();
  if (!merged) return merged.error();
  return Rows{
      {{"results", sessions}, {"tasks", plan.header.tasks.size()}, {"merge_s", merge_s}, {"asked_s", 30}}};
}

namespace {

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
  const Result<std::string> planned =
      run_weft({"batch", "plan", archive.string(), "-o", plan.string(), "--sample", "1", "-q"});
  if (!planned) return planned.error();
  const Result<Killed> killed = run_and_kill(plan, log, kills);
  if (!killed) return killed.error();
  const int half_made = half_made_in(archive);
  const Result<library::MergeReport> merged = library::merge_batch(plan, {});
  if (!merged) return merged.error();
  int once = 0;
  for (const library::BatchRow& row : merged->state.rows) {
    if (list_solves(row.planned->session).size() == 1) ++once;
  }
  const library::BatchSummary& summary = merged->state.summary;
  return Rows{{{"sessions", sessions},
               {"kills", killed->kills},
               {"published_once", once},
               {"failed", summary.failed},
               {"missing", summary.missing},
               {"half_made_before_merge", half_made},
               {"half_made_after", half_made_in(archive)}}};
}

namespace {

constexpr double kMmPerPixel = 0.04;
constexpr std::size_t kWrong = 1;  // of rigs(): its calibration
constexpr std::array<double, 5> kMoved_mm = {0, 5, 10, 20, 40};

struct Rig {
  const char* name;
  simulator::Body body;
  std::vector<simulator::LedRing> rings;
  std::vector<int> left_out;  ///< LEDs that are missing
};

const std::array<Rig, 3>& rigs() {
  static const std::array<Rig, 3> all = {{
      {"attic", simulator::Body::kOffset, {{4, 35, 0, 600}, {6, 62, 15, 600}}, {}},
      {"cellar", simulator::Body::kD5100, {{4, 38, 20, 560}, {4, 60, 65, 560}}, {}},
      {"hall", simulator::Body::kD80, {{6, 40, 0, 640}, {6, 62, 30, 640}}, {4}},
  }};
  return all;
}

const std::array<const char*, 5> kCloths = {"twill", "plain", "satin", "knit", "dyes"};

// A calibration in the place of a session's own.
Result<void> give_calibration(const fs::path& session, const Calibration& calibration, const Rig& rig) {
  const fs::path own = session / "calibration";
  std::error_code ignored;
  fs::remove_all(own, ignored);
  const Result<Calibration> written = write_calibration(own, calibration);
  if (!written) return written.error();
  Result<Json> document = read_json(session / "session.json", "weft.session", 1);
  if (!document) return std::move(document).error();
  (*document)["calibration"] = written->id;
  (*document)["rig"] = rig.name;
  if (!rig.left_out.empty()) (*document)["left_out"] = rig.left_out;
  return write_json(session / "session.json", *document);
}

const Rig& rig_of(int session) {
  return rigs()[static_cast<std::size_t>(session) % rigs().size()];
}

// Sessions of the three rigs in turn, each with photographs of its own; the calibration that the wrong one
// would have if it were right.
Result<Calibration> simulate_rigs(const fs::path& folder, const fs::path& scenes, double megapixels,
                                  int sessions) {
  if (Result<void> made = make_writable_folder(folder); !made) return made.error();
  Calibration right;
  for (int i = 0; i < sessions; ++i) {
    const Rig& rig = rig_of(i);
    const std::size_t cloth = static_cast<std::size_t>(i) / rigs().size() % kCloths.size();
    Result<simulator::Scene> scene = simulator::read_scene(scenes / fmt::format("{}.toml", kCloths[cloth]));
    if (!scene) return std::move(scene).error();
    set_size(scene->camera, megapixels);
    scene->camera.mm_per_pixel = kMmPerPixel;
    scene->camera.body = rig.body;
    scene->lights.rings = rig.rings;
    scene->lights.leds.clear();
    scene->seed += i;
    if (Result<void> made = simulate_own(session_in(folder, i), *scene); !made) return made.error();
    Result<Calibration> calibration = read_calibration(session_in(folder, i) / "calibration");
    if (!calibration) return std::move(calibration).error();
    calibration->subject.rig = rig.name;
    if (Result<void> given = give_calibration(session_in(folder, i), *calibration, rig); !given)
      return given.error();
    if (&rig == &rigs()[kWrong]) right = std::move(*calibration);
  }
  return right;
}

// Two LEDs stand elsewhere than the calibration has them.
Calibration misplaced(Calibration calibration, double by_mm) {
  auto& leds = std::get<NearLights>(*calibration.lights).leds;
  leds[1].position_mm = leds[1].position_mm + by_mm * normalized(Vec3{2, -1, 1});
  leds[5].position_mm = leds[5].position_mm + by_mm * normalized(Vec3{-1, 2, -1});
  return calibration;
}

// Plans and solves the archive into `folder`, and reads what came of it.
Result<library::MergeReport> solve_all(const fs::path& folder, const fs::path& archive, int threads) {
  const fs::path plan = folder / "plan.jsonl";
  const std::string cores = std::to_string(threads);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"batch", "plan", archive.string(), "-o", plan.string(), "--sample", "0",
                                 "--output", (folder / "solves").string(), "-q"},
        {"batch", "run", plan.string(), "-q", "--threads", cores}}) {
    if (const Result<std::string> said = run_weft(arguments); !said) return said.error();
  }
  return library::merge_batch(plan, {});
}

Json row_of(double moved_mm, const library::BatchState& state) {
  double wrong = 0, others = 0;
  for (const library::ByCalibration& each : state.summary.calibrations) {
    double& left_out = each.rig == rigs()[kWrong].name ? wrong : others;
    left_out = std::max(left_out, each.left_out.value_or(0));
  }
  const std::vector<Verdict> verdicts = library::verdicts_of(state);
  return {{"moved_mm", moved_mm},
          {"sessions", state.rows.size()},
          {"left_out_percent", 100 * wrong},
          {"others_percent", 100 * others},
          {"first", state.summary.calibrations.front().rig},
          {"suspect", !verdicts.empty() && verdicts.front().name == "CALIBRATION_SUSPECT"}};
}

}  // namespace

Result<Rows> batch_rigs(const StudyOptions& options) {
  const TemporaryFolder folder;
  const fs::path archive = folder.path() / "archive";
  const Result<Calibration> right =
      simulate_rigs(archive, options.scene.parent_path(), options.megapixels, options.runs);
  if (!right) return right.error();
  Rows rows;
  for (const double moved_mm : kMoved_mm) {
    const Calibration wrong = misplaced(*right, moved_mm);
    for (int i = kWrong; fs::exists(session_in(archive, i)); i += static_cast<int>(rigs().size())) {
      if (Result<void> ok = give_calibration(session_in(archive, i), wrong, rig_of(i)); !ok)
        return ok.error();
    }
    const fs::path own = folder.path() / fmt::format("{:.0f}", moved_mm);
    if (Result<void> made = make_writable_folder(own); !made) return made.error();
    const Result<library::MergeReport> merged = solve_all(own, archive, resolved_threads(options.threads));
    if (!merged) return merged.error();
    rows.push_back(row_of(moved_mm, merged->state));
  }
  return rows;
}

}  // namespace weft::bench
