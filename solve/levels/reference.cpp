// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/reference.h"

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "solve/correction/leave_out_lights.h"
#include "solve/correction/light_choice.h"
#include "solve/levels/stages.h"
#include "solve/photographs/picture_axes.h"
#include "solve/photographs/samples.h"

namespace weft::solve {
namespace {

Vec3 normal_of(const SolvedFrame& frame, int x, int y) {
  return {frame.normal(x, y, 0), frame.normal(x, y, 1), frame.normal(x, y, 2)};
}

// Keeps a solve in memory, and by how much it turned the normals of the one before, if there is one.
class FrameKeeper {
 public:
  FrameKeeper(const Photographs& photographs, const SolvedFrame* before)
      : planes_(photographs.planes()), axes_(picture_from_rig(photographs.camera)), before_(before) {
    frame = {Image<float>(photographs.size, 3), Image<float>(photographs.size, planes_.count)};
  }

  Result<void> operator()(const MapBand& band) {
    for (int y = 0; y < band.rows.height(); ++y) keep_normals(band, y);
    for (int y = 0; y < band.albedo_rows.height(); ++y) keep_albedo(band, y);
    return {};
  }
  double mean_turn_deg() const { return turned_deg_ / static_cast<double>(frame.normal.size().pixels()); }

  SolvedFrame frame;

 private:
  void keep_normals(const MapBand& band, int y) {
    const int row = band.rows.y0 + y;
    for (int x = 0; x < band.rows.width(); ++x) {
      const Vec3 n = axes_ * Vec3{band.normal[0](x, y), band.normal[1](x, y), band.normal[2](x, y)};
      if (before_ != nullptr) turned_deg_ += angle_deg(normal_of(*before_, x, row), n);
      frame.normal(x, row, 0) = static_cast<float>(n.x);
      frame.normal(x, row, 1) = static_cast<float>(n.y);
      frame.normal(x, row, 2) = static_cast<float>(n.z);
    }
  }
  void keep_albedo(const MapBand& band, int y) {
    const int row = band.albedo_rows.y0 + y;
    for (int p = 0; p < frame.albedo.planes(); ++p) {
      float* kept = frame.albedo.plane(p).row(row);
      for (int x = 0; x < band.albedo_rows.width(); ++x) {
        kept[x] = band.albedo[static_cast<std::size_t>(planes_.channel_at(p, x, row))](x, y);
      }
    }
  }

  Planes planes_;
  Mat3 axes_;
  const SolvedFrame* before_;
  double turned_deg_ = 0;
};

// The turn of the round after two, degrees; `before` is 0 where there was no round before the last.
double expected_turn(double before, double last) {
  return before > last ? last * last / before : last;
}

Result<void> open_gates(Solving& s) {
  Stopwatch watch;
  Result<solver::Gates> gates = measure_gates(
      solve_samples(s.photographs, *solver::standard_method(), s.context.threads), s.photographs);
  if (!gates) return std::move(gates).error();
  s.light = {gates->shadows(), gates->interreflection()};
  s.facts.reference.emplace().gates = std::move(*gates);
  s.facts.work.samples += watch.lap();
  return {};
}

// Solves the frame by what the stages before have found. What follows is judged against that.
Result<void> find_relief(const ReferenceOptions& options, Solving& s) {
  s.below = {s.method, s.facts.gloss};
  if (!s.facts.reference) s.facts.reference.emplace();
  FrameKeeper frame(s.photographs, nullptr);
  const Result<double> solved = solve_bands(s.photographs, *s.method, s.tile, s.context, std::ref(frame));
  if (!solved) return solved.error();
  Result<std::shared_ptr<SolvedRelief>> relief =
      SolvedRelief::of(s.photographs, std::move(frame.frame), options, s.context.threads);
  if (!relief) return std::move(relief).error();
  s.relief = std::move(*relief);
  s.relief->facts.stages = s.light;
  return {};
}

// Leaves in `light` what earns its place by this relief.
Result<LightChoice> choose_by(SolvedRelief& relief, Solving& s) {
  Stopwatch watch;
  LightCorrection correction = relief.correction_of(s.light);
  Result<LightChoice> choice =
      choose_light(s.photographs, *s.method, relief.solved, correction, s.light, s.context);
  if (choice) s.light = relief.facts.stages = choice->stages;
  s.facts.work.choice += watch.lap();
  return choice;
}

Result<void> choose_by_first_relief(Solving& s) {
  Result<LightChoice> choice = choose_by(*s.relief, s);
  if (!choice) return std::move(choice).error();
  s.facts.reference->choice = *choice;
  if (!s.light.any()) s.relief.reset();
  return {};
}

// The better the relief, the better the scale of the albedo is known.
bool has_scale_to_find(const Solving& s) {
  return s.facts.reference->choice.stages.any() && s.light.interreflection &&
         s.photographs.albedo_scale == AlbedoScale::kRelative;
}

// Solves what the light of a relief leaves of the readings, and says in its facts how that turned normals.
Result<SolvedFrame> solve_early(SolvedRelief& round, const Solving& s) {
  FrameKeeper frame(s.photographs, &round.solved);
  LightCorrection correction = round.early_correction();
  const Result<double> solved =
      solve_bands(s.photographs, *s.method, s.tile, s.context, std::ref(frame), {.correction = &correction});
  if (!solved) return solved.error();
  round.facts.turned_deg = frame.mean_turn_deg();
  return std::move(frame.frame);
}

// Rounds until the normals settle, or a round is refused.
Result<void> approach(Solving& s) {
  std::vector<ReferenceRound>& rounds = s.facts.reference->rounds;
  const ReferenceOptions options = s.relief->options;
  std::shared_ptr<SolvedRelief> round = s.relief;
  for (bool settled = false; !settled && static_cast<int>(rounds.size()) + 1 < options.most_rounds;) {
    Result<SolvedFrame> frame = solve_early(*round, s);
    if (!frame) return std::move(frame).error();
    const double before = rounds.empty() ? 0 : rounds.back().turned_deg, turned = round->facts.turned_deg;
    settled = expected_turn(before, turned) < options.settled_deg;
    round->facts.is_refused = !settled && before > 0 && turned >= before;
    rounds.push_back(round->facts);
    if (round->facts.is_refused) return {};
    s.relief = std::move(round);
    Result<std::shared_ptr<SolvedRelief>> next =
        SolvedRelief::of(s.photographs, std::move(*frame), options, s.context.threads);
    if (!next) return std::move(next).error();
    round = std::move(*next);
    round->facts.stages = s.light;
    if (!has_scale_to_find(s)) continue;
    if (Result<LightChoice> choice = choose_by(*round, s); !choice) return std::move(choice).error();
    if (!s.light.any()) return {};
  }
  s.relief = std::move(round);
  return {};
}

// Drops the relief where the level below predicts left-out light better.
Result<void> compare_with_below(Solving& s) {
  Stopwatch watch;
  const std::vector<solver::Patch> few =
      of_few_rows(solver::patches_of(s.photographs.size, solver::PatchUse::kReport), s.photographs.size);
  LightCorrection correction = s.relief->correction();
  Result<solver::LeftOut> left_out =
      leave_out_lights(s.photographs, {.method = s.method, .correction = &correction}, few, s.context);
  if (!left_out) return std::move(left_out).error();
  const Result<solver::LeftOut> of_below =
      leave_out_lights(s.photographs, {.method = s.below.method}, few, s.context);
  if (!of_below) return of_below.error();
  s.facts.work.few_rows += watch.lap();
  ReferenceFacts& facts = *s.facts.reference;
  facts.over_robust = gain_of_correction(*of_below, *left_out);
  facts.robust_is_published = facts.over_robust.mean < 0;
  if (!facts.robust_is_published) {
    s.facts.left_out = std::move(*left_out);
    return {};
  }
  s.relief.reset();
  s.method = s.below.method;
  s.facts.gloss = s.below.gloss;
  if (s.facts.gloss) s.facts.gloss->seconds = s.facts.work.lobe;
  return {};
}

Result<void> correct_readings(Solving& s) {
  LightCorrection& correction = s.keep(correction_by_relief(s));
  ReferenceFacts& facts = *s.facts.reference;
  facts.stages = s.relief->facts.stages;
  facts.rounds.push_back(s.relief->facts);
  facts.rounds.back().turned_deg = 0;
  facts.shadow_reach_is_capped = correction.shadow_reach_is_capped();
  s.bands.correction = &correction;
  s.bands.model->bounces_are_out = facts.stages.interreflection;
  return {};
}

}  // namespace

Stage gates_stage() {
  return {
      "gates", "tells on sample tiles whether shadows or bounces can be worth taking out", {}, open_gates};
}

Stage relief_stage(const ReferenceOptions& options) {
  return {"relief", "solves the frame and integrates its normals to the heights that cast and throw light",
          [](const Solving& s) { return s.light.any(); },
          [options](Solving& s) { return find_relief(options, s); }};
}

Stage choice_stage() {
  return {"choice", "keeps of shadows and bounces what predicts left-out light better", has_relief,
          choose_by_first_relief};
}

Stage rounds_stage() {
  return {"rounds", "solves what they leave of the readings and integrates again, until normals settle",
          has_relief, approach};
}

Stage comparison_stage() {
  return {"comparison", "goes back to the level below where that predicts left-out light better", has_relief,
          compare_with_below};
}

Stage correction_stage() {
  return {"correction", "takes shadows and bounces of the last relief out of the readings", has_relief,
          correct_readings};
}

}  // namespace weft::solve
