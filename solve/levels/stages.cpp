// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/stages.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/statistics.h"

#include "solve/bands/deblur.h"
#include "solve/bands/realign.h"
#include "solve/correction/leave_out_lights.h"
#include "solve/gloss/gloss.h"

namespace weft::solve {
namespace {

Planes solved_planes(const Solving& s) {
  return s.method->wants_rgb() ? Planes() : s.photographs.planes();
}

bool has_lateral_color(const Solving& s) {
  return s.photographs.lateral && s.photographs.camera && solved_planes(s).count == 1;
}

Result<void> sharpen_bands(Solving& s) {
  const BandSink& next = s.keep(std::make_unique<BandSink>(s.sink));
  Deblur& deblur = s.keep(std::make_unique<Deblur>(s.photographs.size, solved_planes(s),
                                                   *s.photographs.spread, s.context.threads, next));
  s.sink = [&deblur, &facts = s.facts](const MapBand& band) {
    Result<void> taken = deblur.put(band);
    facts.deblur = deblur.facts();
    return taken;
  };
  return {};
}

Result<void> realign_bands(Solving& s) {
  const LateralColor& lateral = *s.photographs.lateral;
  const CameraModel& camera = *s.photographs.camera;
  const BandSink& next = s.keep(std::make_unique<BandSink>(s.sink));
  Realign& realign = s.keep(std::make_unique<Realign>(s.photographs.size, solved_planes(s).cfa, lateral,
                                                      camera, s.context.threads, next));
  s.sink = [&realign](const MapBand& band) { return realign.put(band); };
  s.facts.lateral_corner_px = {shift_at_corner(lateral.red, camera), shift_at_corner(lateral.blue, camera)};
  return {};
}

Result<void> choose_blocks(Solving& s) {
  const solver::Method& robust = s.keep(solver::robust_method());
  Result<solver::BlockChoice> choice =
      choose_by_block(s.photographs, {.method = s.method}, {.method = &robust}, s.context);
  if (!choice) return std::move(choice).error();
  if (choice->share() > 0) {
    const CurlWitness curl = ask_curl(s.photographs, *s.method, robust, *choice, s.context.threads);
    if (curl.objects()) {
      s.facts.robust_share = 0;
      s.facts.against_robust = curl;
      return {};
    }
  }
  s.facts.robust_share = choice->share();
  s.method = &s.keep(solver::blended_method(*s.method, robust, *choice));
  s.bands.robust = &s.keep(std::make_unique<solver::BlockChoice>(std::move(*choice)));
  return {};
}

// Reads through the correction of the relief, if there is one: blocks are then chosen on few rows.
Result<void> find_lobe(Solving& s) {
  Stopwatch watch;
  if (s.lambert == nullptr) s.lambert = s.method;
  const std::unique_ptr<LightCorrection> correction = correction_by_relief(s);
  Result<Gloss> found = Gloss::find(s.photographs, *s.lambert, correction.get(), s.context);
  if (!found) return std::move(found).error();
  s.facts.work.lobe += found->facts.seconds;
  if (correction) s.facts.work.few_rows += watch.lap() - found->facts.seconds;
  s.facts.gloss = found->facts;
  s.facts.gloss->seconds = s.facts.work.lobe;
  s.method = &s.keep(std::make_unique<Gloss>(std::move(*found))).over(*s.lambert);
  return {};
}

// What the stages before have found tells of the model's error.
void add_traits(const FrameFacts& facts, solver::ModelTraits& traits) {
  if (facts.gloss) {
    traits.lobe_share = facts.gloss->share;
    traits.lobe_misfit = facts.gloss->misfit;
  }
  if (!facts.left_out) return;
  const solver::LeftOutError error = solver::error_of_all(*facts.left_out);
  if (error.readings > 0 && error.noise_median > 0) traits.unpredicted = error.median / error.noise_median;
  std::vector<double> turned;
  for (const float deg : facts.left_out->turned_deg) {
    if (std::isfinite(deg)) turned.push_back(static_cast<double>(deg));
  }
  if (!turned.empty()) traits.turned_deg = median(std::move(turned));
}

Result<void> solve_tiles(Solving& s) {
  s.bands.tally = &s.facts.tally;
  if (s.looks_at_blocks) s.bands.blocks = &s.facts.blocks;
  if (s.bands.model) add_traits(s.facts, *s.bands.model);
  const Result<double> waited = solve_bands(s.photographs, *s.method, s.tile, s.context, s.sink, s.bands);
  if (!waited) return waited.error();
  s.facts.waited_seconds = *waited;
  return {};
}

// What lights tell of the way the frame is solved, when they are left out.
Result<void> leave_out_each_light(Solving& s) {
  std::vector<solver::Patch> patches = solver::patches_of(s.photographs.size, solver::PatchUse::kReport);
  const std::unique_ptr<LightCorrection> correction = correction_by_relief(s);
  if (correction) patches = of_few_rows(patches, s.photographs.size);
  Result<solver::LeftOut> left_out = leave_out_lights(
      s.photographs, {.method = s.method, .correction = correction.get()}, patches, s.context);
  if (!left_out) return std::move(left_out).error();
  s.facts.left_out = std::move(*left_out);
  return {};
}

}  // namespace

std::vector<Stage> stages_of(const solver::MethodName& method, const ReferenceOptions& options) {
  using solver::Level;
  const Level level = method.level.value_or(Level::kStandard);
  std::vector<Stage> stages;
  const auto from = [&](Level least, Stage stage) {
    if (level >= least) stages.push_back(std::move(stage));
  };
  from(Level::kPreview, method_stage(level > Level::kStandard ? method_of(Level::kStandard) : method));
  from(Level::kPreview, sharpen_stage());
  from(Level::kPreview, realign_stage());
  from(Level::kRobust, blocks_stage());
  from(Level::kRobust, lobe_stage());
  from(Level::kReference, gates_stage());
  from(Level::kReference, relief_stage(options));
  from(Level::kReference, choice_stage());
  from(Level::kReference, rounds_stage());
  from(Level::kReference, second_lobe_stage());
  from(Level::kReference, comparison_stage());
  from(Level::kReference, correction_stage());
  from(Level::kPreview, check_stage());
  from(Level::kPreview, solve_stage());
  return stages;
}

Stage method_stage(const solver::MethodName& method) {
  return {method.name, method.help, {}, [method](Solving& s) -> Result<void> {
            s.method = &s.keep(method.make());
            s.bands.model = solver::ModelTraits{.is_half = method.extent == solver::Extent::kHalfSize,
                                                .sigma_slope = s.photographs.sigma_slope,
                                                .is_fast = method.level == solver::Level::kFast};
            return {};
          }};
}

Stage sharpen_stage() {
  return {"sharpen", "undoes the blur of the lens in the maps, where its spread is known",
          [](const Solving& s) { return s.photographs.spread.has_value(); }, sharpen_bands};
}

Stage realign_stage() {
  return {"realign", "lays red and blue of a mosaic where green is, where lateral colour is known",
          has_lateral_color, realign_bands};
}

Stage blocks_stage() {
  return {"blocks", "solves blocks robustly where that predicts left-out light better", {}, choose_blocks};
}

Stage lobe_stage() {
  return {"lobe",
          "finds the lobe of a glossy cloth, and uses it on blocks where that predicts better",
          {},
          find_lobe};
}

Stage second_lobe_stage() {
  return {"second lobe", "finds the lobe again in readings that the relief corrects", has_relief, find_lobe};
}

Stage solve_stage() {
  return {"solve", "solves the frame by all that, band by band", {}, solve_tiles};
}

Stage check_stage() {
  return {"check", "leaves out one light after another and says how well the others predict it",
          [](const Solving& s) { return !s.facts.left_out; }, leave_out_each_light};
}

}  // namespace weft::solve
