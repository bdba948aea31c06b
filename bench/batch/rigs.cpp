// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <variant>
#include <vector>

#include "app/jobs/batch/batch_page.h"
#include "app/jobs/batch/merge_batch.h"
#include "bench/batch/archive.h"
#include "bench/batch/studies.h"
#include "core/calibration.h"
#include "core/files.h"
#include "core/json_document.h"
#include "core/parallel.h"
#include "core/temporary_folder.h"
#include "simulator/scene/scene.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

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
Result<app::MergeReport> solve_all(const fs::path& folder, const fs::path& archive, int threads) {
  const fs::path plan = folder / "plan.jsonl", log = folder / "log";
  const std::string cores = std::to_string(threads);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"batch", "plan", archive.string(), "-o", plan.string(), "--sample", "0",
                                 "--output", (folder / "solves").string(), "-q"},
        {"batch", "run", plan.string(), "-q", "--threads", cores}}) {
    const Result<int> code = run_program(arguments, log);
    if (!code) return code.error();
    if (*code != 0) return ended_with(arguments[1], *code, log);
  }
  return app::merge_batch(plan, {});
}

Json row_of(double moved_mm, const app::BatchState& state) {
  double wrong = 0, others = 0;
  for (const batch::ByCalibration& each : state.summary.calibrations) {
    double& left_out = each.rig == rigs()[kWrong].name ? wrong : others;
    left_out = std::max(left_out, each.left_out.value_or(0));
  }
  const std::vector<Verdict> verdicts = app::verdicts_of(state);
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
    const Result<app::MergeReport> merged = solve_all(own, archive, resolved_threads(options.threads));
    if (!merged) return merged.error();
    rows.push_back(row_of(moved_mm, merged->state));
  }
  return rows;
}

}  // namespace weft::bench
