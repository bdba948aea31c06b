// SPDX-License-Identifier: Apache-2.0
#include "bench/cloths/cloths.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "bench/cloths/block_errors.h"
#include "bench/cloths/photographs.h"
#include "core/base/statistics.h"
#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "core/image_io/solve_maps.h"
#include "core/solve/solve_record.h"
#include "simulator/simulate.h"
#include "solve/run/solve_session.h"
#include "solver/method.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr Size kPhotograph = {160, 160}, kFrame = {256, 192};
// The solver cannot know the cloth beyond the border.
constexpr int kEdge = 12;

struct Held {
  double true_deg = 0, over_sigma = 0, beyond_3 = 0;
};

Result<Held> hold(const fs::path& solve, const Image<float>& truth) {
  const Result<SolveMaps> maps = SolveMaps::open(solve);
  if (!maps) return maps.error();
  const Result<LoadedImage> normal = maps->normal(), sigma = maps->sigma();
  const Result<Image<std::uint16_t>> status = maps->status();
  if (!normal) return normal.error();
  if (!sigma) return sigma.error();
  if (!status) return status.error();
  const View<const float> n[3] = {normal->channel("X"), normal->channel("Y"), normal->channel("Z")};
  const View<const float> sigma_deg = sigma->channel("normal_deg");
  const int scale = truth.width() / maps->size().width;
  Held held;
  std::vector<double> ratios;
  for (int y = kEdge; y < truth.height() - kEdge; ++y) {
    for (int x = kEdge; x < truth.width() - kEdge; ++x) {
      const int u = x / scale, v = y / scale;
      if ((*status)(u, v) & kNoSolution) continue;
      const double off =
          angle_deg({n[0](u, v), n[1](u, v), n[2](u, v)}, {truth(x, y, 0), truth(x, y, 1), truth(x, y, 2)});
      held.true_deg += off;
      ratios.push_back(off / static_cast<double>(sigma_deg(u, v)));
      held.beyond_3 += ratios.back() > 3;
    }
  }
  if (ratios.empty()) return held;
  held.true_deg /= static_cast<double>(ratios.size());
  held.beyond_3 /= static_cast<double>(ratios.size());
  held.over_sigma = median(std::move(ratios));
  return held;
}

std::string said_by(const SolveFacts& facts) {
  std::string said;
  for (const Verdict& verdict : facts.warnings) said += (said.empty() ? "" : " ") + verdict.name;
  return said;
}

Result<Json> row_of(const KindOfCloth& cloth, std::uint32_t seed, const solver::MethodName& level,
                    const Result<solve::SolveReport>& solved, const fs::path& folder,
                    const Image<float>& truth) {
  Json row = {{"cloth", cloth.name}, {"seed", seed}, {"quality", level.name}};
  if (!solved) return solved.error();
  const Result<Held> held = hold(folder, truth);
  if (!held) return held.error();
  row["true_deg"] = held->true_deg;
  row["foretold_deg"] = solved->expected.total_deg;
  row["ratio"] = held->true_deg / solved->expected.total_deg;
  row["over_sigma"] = held->over_sigma;
  row["beyond_3"] = held->beyond_3;
  const std::optional<ConditionFacts>& conditions = solved->facts.conditions;
  const bool is_told = conditions && conditions->cloth_spread;
  row["spreads"] = cloth.scene.material.translucency.share;
  row["told"] = is_told ? conditions->cloth_spread->share : 0;
  row["said"] = said_by(solved->facts);
  return row;
}

// A solve of what was written by a level, into `output`.
using SolveBy = std::function<Result<solve::SolveReport>(const solve::SolveOptions&)>;

Result<void> add_levels(const KindOfCloth& cloth, std::uint32_t seed, const ClothsOptions& asked,
                        const fs::path& scratch, const Image<float>& truth, const SolveBy& solve,
                        Rows& rows) {
  for (const solver::MethodName& level : solver::method_names()) {
    if (!level.level) continue;
    if (!asked.methods.empty() && std::ranges::count(asked.methods, level.name) == 0) continue;
    solve::SolveOptions options;
    options.method = level.name;
    options.output = scratch / level.name;
    options.previews = false;
    options.looks_at_blocks = !asked.blocks.empty();
    const Result<solve::SolveReport> solved = solve(options);
    if (solved && !asked.blocks.empty()) {
      const Result<void> ok =
          append_blocks({cloth.name, seed, level.name, asked.as_session}, *solved, truth, asked.blocks);
      if (!ok) return ok;
    }
    if (Result<void> ok = add_row(rows, row_of(cloth, seed, level, solved, options.output, truth)); !ok)
      return ok;
  }
  return {};
}

Result<void> add_photographs(const KindOfCloth& cloth, std::uint32_t seed, const ClothsOptions& asked,
                             const JobContext& context, Rows& rows) {
  const TemporaryFolder scratch;
  const fs::path folder = scratch.path() / "photographs";
  fs::create_directories(folder);
  const Result<WrittenPhotographs> written =
      write_photographs(cloth, kPhotograph, seed, folder, context.threads);
  if (!written) return written.error();
  return add_levels(
      cloth, seed, asked, scratch.path(), written->normal,
      [&](const solve::SolveOptions& options) {
        return solve::solve_photos(written->input, options, context);
      },
      rows);
}

Result<void> add_session(const KindOfCloth& cloth, std::uint32_t seed, const ClothsOptions& asked,
                         const JobContext& context, Rows& rows) {
  const TemporaryFolder scratch;
  const fs::path session = scratch.path() / "cloth.weft", truth = scratch.path() / "truth";
  simulator::Scene scene = cloth.scene;
  scene.camera.width = kFrame.width;
  scene.camera.height = kFrame.height;
  const auto simulated = simulator::simulate_session(
      scene, session, {.tiles = {.threads = context.threads}, .stop = {}, .progress = {}});
  if (!simulated) return simulated.error();
  // A session with a truth is held against it, which no user's is.
  fs::rename(session / "truth", truth);
  const Result<LoadedImage> normal = read_image(truth / "normal.exr");
  if (!normal) return normal.error();
  Image<float> planes(kFrame, 3);
  for (const auto& [c, name] : {std::pair{0, "X"}, {1, "Y"}, {2, "Z"}}) {
    for (int y = 0; y < kFrame.height; ++y)
      std::copy_n(normal->channel(name).row(y), kFrame.width, planes.plane(c).row(y));
  }
  const solve::SessionOptions input = {.folder = session, .calibration = {}, .leds = {}};
  return add_levels(
      cloth, seed, asked, scratch.path(), planes,
      [&](const solve::SolveOptions& options) { return solve::solve_session(input, options, context); },
      rows);
}

}  // namespace

Result<Rows> cloths_table(const ClothsOptions& asked, const StudyOptions& options) {
  Rows rows;
  JobContext context;
  context.threads = options.threads;
  const std::span<const std::string> names = names_of_kinds(asked.set);
  int done = 0;
  for (const std::string& name : names) {
    for (int run = 0; run < options.runs; ++run) {
      if (!asked.kind.empty() && asked.kind != name) continue;
      const auto seed = static_cast<std::uint32_t>(options.seed) + static_cast<std::uint32_t>(run);
      const KindOfCloth cloth = draw_kind(name, seed);
      // Parts of a session would have to be one scene.
      if (asked.as_session && !cloth.parts.empty()) continue;
      const Result<void> ok = asked.as_session ? add_session(cloth, seed, asked, context, rows)
                                               : add_photographs(cloth, seed, asked, context, rows);
      if (!ok) return ok.error();
    }
    options.progress(++done, static_cast<int>(names.size()));
  }
  return rows;
}

}  // namespace weft::bench
