// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/reference.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "solve/correction/left_out.h"
#include "solve/photographs/picture_axes.h"
#include "solve/photographs/samples.h"
#include "solver/height/height.h"

namespace weft::pipeline {
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

// Of the round after two, degrees; `before` is 0 where there was no round before the last.
double expected_turn(double before, double last) {
  return before > last ? last * last / before : last;
}

// One round: a frame, its relief, what its light does to readings, and a solve of what is left of them.
class Round {
 public:
  // The others must outlive it.
  Round(const Photographs& photographs, SolvedFrame frame, const ReferenceOptions& options,
        const JobContext& context)
      : solved(std::move(frame)), photographs_(photographs), options_(options), context_(context) {}

  Result<void> integrate() {
    Stopwatch watch;
    solver::HeightOptions options;
    options.threads = context_.threads;
    Result<solver::Height> height = solver::height_from_normals(
        {solved.normal.plane(0), solved.normal.plane(1), solved.normal.plane(2)}, {}, options);
    if (!height) return std::move(height).error();
    facts.slope_residual_rms = height->slope_residual_rms;
    height_ = std::move(height->height_mm);
    Result<solver::Relief> relief = solver::Relief::of(height_.plane(), 1);
    if (!relief) return std::move(relief).error();
    relief_ = *relief;
    facts.height_seconds = watch.lap();
    return {};
  }

  // Sets `stages` to those of the candidates that earn their place.
  Result<LightChoice> choose(const LightStages& candidates, const solver::Method& method) {
    Stopwatch watch;
    LightCorrection correction = correct(candidates);
    Result<LightChoice> choice = choose_light(photographs_, method, solved, correction, candidates, context_);
    if (choice) facts.stages = choice->stages;
    facts.choice_seconds = watch.lap();
    return choice;
  }

  Result<double> solve(const solver::Method& method, const TileOptions& tile, bool is_last,
                       const BandSink& sink, BandOptions options) {
    Stopwatch watch;
    LightCorrection correction = correct(facts.stages, is_last);
    reach_is_capped = correction.shadow_reach_is_capped();
    options.correction = &correction;
    Result<double> waited = solve_bands(photographs_, method, tile, context_, sink, options);
    facts.light_seconds = correction.seconds();
    facts.solve_seconds = watch.lap() - correction.seconds();
    return waited;
  }

  Result<solver::LeftOut> leave_out_lights_of(std::span<const solver::Patch> patches,
                                              const solver::Method& method) const {
    LightCorrection correction = correct(facts.stages);
    return leave_out_lights(photographs_, {.method = &method, .correction = &correction}, patches, context_);
  }

  Result<Gloss> find_gloss(const solver::Method& base) const {
    LightCorrection correction = correct(facts.stages);
    return Gloss::find(photographs_, base, &correction, context_);
  }

  ReferenceRound facts;
  SolvedFrame solved;
  bool reach_is_capped = false;

 private:
  LightCorrection correct(const LightStages& stages, bool is_last = true) const {
    const int directions = is_last ? options_.directions : options_.early_directions;
    const int steps = is_last ? options_.steps : options_.early_steps;
    return {photographs_, solved, relief_, {stages, directions, steps, options_.reach_px}, context_.threads};
  }

  const Photographs& photographs_;
  const ReferenceOptions& options_;
  const JobContext& context_;
  Image<float> height_;
  solver::Relief relief_;
};

// A solve under way.
class Reference {
 public:
  Reference(const Photographs& photographs, const TileOptions& tile, const ReferenceOptions& options,
            const JobContext& context)
      : photographs_(photographs), tile_(tile), options_(options), context_(context) {}

  // By which method each block is solved.
  Result<void> choose_methods() {
    Result<solver::BlockChoice> choice = choose_by_block(photographs_, {.method = standard_.get()},
                                                         {.method = robust_method_.get()}, context_);
    if (!choice) return std::move(choice).error();
    facts.robust_share = choice->share();
    method_ = solver::blended_method(*standard_, *robust_method_, *choice);
    robust_ = std::move(*choice);
    Result<Gloss> gloss = Gloss::find(photographs_, *method_, nullptr, context_);
    if (!gloss) return std::move(gloss).error();
    facts.work.lobe += gloss->facts.seconds;
    facts.gloss = gloss->facts;
    gloss_ = std::move(*gloss);
    below_ = &gloss_->over(*method_);
    return {};
  }

  Result<void> find_candidates() {
    Stopwatch watch;
    Result<solver::Gates> gates = measure_gates(
        solve_samples(photographs_, *solver::standard_method(), context_.threads), photographs_);
    if (!gates) return std::move(gates).error();
    facts.gates = *gates;
    facts.stages = {options_.force_stages || gates->shadows(),
                    options_.force_stages || gates->interreflection()};
    facts.work.samples = watch.lap();
    return {};
  }

  // Rounds until the normals settle, or a round is refused. The last solve is of readings corrected by
  // `last_`, if there is one.
  Result<void> approach() {
    FrameKeeper first(photographs_, nullptr);
    if (const auto solved = solve_bands(photographs_, *below_, tile_, context_, std::ref(first)); !solved) {
      return solved.error();
    }
    SolvedFrame frame = std::move(first.frame);
    for (bool settled = false;;) {
      auto round = std::make_unique<Round>(photographs_, std::move(frame), options_, context_);
      if (Result<void> ok = round->integrate(); !ok) return ok;
      if (Result<void> ok = choose(*round); !ok) return ok;
      if (!facts.stages.any()) return {};
      const bool done = settled || static_cast<int>(facts.rounds.size()) + 1 >= options_.most_rounds;
      if (done) {
        last_ = std::move(round);
        return {};
      }
      FrameKeeper next(photographs_, &round->solved);
      const Result<double> solved = round->solve(*below_, tile_, /*is_last=*/false, std::ref(next), {});
      if (!solved) return solved.error();
      ReferenceRound& now = round->facts;
      now.turned_deg = next.mean_turn_deg();
      const double before = facts.rounds.empty() ? 0 : facts.rounds.back().turned_deg;
      settled = expected_turn(before, now.turned_deg) < options_.settled_deg;
      now.is_refused = !settled && before > 0 && now.turned_deg >= before;
      facts.rounds.push_back(now);
      if (now.is_refused) return {};
      last_ = std::move(round);
      frame = std::move(next.frame);
    }
  }

  // Drops the last round where the level below predicts left-out light better.
  Result<void> hold_against_below() {
    Stopwatch watch;
    const std::vector<solver::Patch> few =
        of_few_rows(solver::patches_of(photographs_.size, solver::PatchUse::kReport), photographs_.size);
    Result<Gloss> gloss = last_->find_gloss(*method_);
    if (!gloss) return std::move(gloss).error();
    const solver::Method& method = gloss->over(*method_);
    Result<solver::LeftOut> left_out = last_->leave_out_lights_of(few, method);
    if (!left_out) return std::move(left_out).error();
    const Result<solver::LeftOut> of_below =
        leave_out_lights(photographs_, {.method = below_}, few, context_);
    if (!of_below) return of_below.error();
    facts.work.lobe += gloss->facts.seconds;
    facts.work.few_rows += watch.lap() - gloss->facts.seconds;
    facts.over_robust = gain_of_correction(*of_below, *left_out);
    facts.robust_is_published = !options_.force_stages && facts.over_robust.mean < 0;
    gloss->facts.seconds += facts.gloss.seconds;
    if (facts.robust_is_published) {
      facts.gloss.seconds = gloss->facts.seconds;
      last_.reset();
      return {};
    }
    facts.gloss = gloss->facts;
    last_gloss_ = std::move(*gloss);
    last_method_ = &method;
    facts.left_out = std::move(*left_out);
    return {};
  }

  Result<void> finish(const BandSink& sink) {
    facts.stages = last_ ? last_->facts.stages : LightStages{};
    const BandOptions bands = {.tally = &facts.tally,
                               .model = solver::ModelTraits{.bounces_are_out = facts.stages.interreflection},
                               .robust = &*robust_};
    const Result<double> waited = last_ ? last_->solve(*last_method_, tile_, /*is_last=*/true, sink, bands)
                                        : solve_bands(photographs_, *below_, tile_, context_, sink, bands);
    if (!waited) return waited.error();
    facts.waited_seconds = *waited;
    if (!last_) return check();
    facts.rounds.push_back(last_->facts);
    facts.rounds.back().turned_deg = 0;
    facts.shadow_reach_is_capped = last_->reach_is_capped;
    return {};
  }

  bool goes_beyond_robust() const { return last_ != nullptr; }

  ReferenceFacts facts;

 private:
  // Leaves in facts.stages what earns its place by the relief of the first round, and of each where the scale
  // of the albedo has to be found: the better the relief, the better it is known.
  Result<void> choose(Round& round) {
    const bool is_chosen = !facts.rounds.empty() && (!facts.stages.interreflection ||
                                                     photographs_.albedo_scale == AlbedoScale::kAbsolute);
    if (options_.force_stages || is_chosen) {
      round.facts.stages = facts.stages;
      return {};
    }
    Result<LightChoice> choice = round.choose(facts.stages, *below_);
    if (!choice) return std::move(choice).error();
    facts.work.choice += round.facts.choice_seconds;
    facts.stages = choice->stages;
    if (facts.rounds.empty()) facts.choice = *choice;
    return {};
  }

  // Leaves lights out of the level below.
  Result<void> check() {
    Result<solver::LeftOut> left_out =
        leave_out_lights(photographs_, {.method = below_},
                         solver::patches_of(photographs_.size, solver::PatchUse::kReport), context_);
    if (!left_out) return std::move(left_out).error();
    facts.left_out = std::move(*left_out);
    return {};
  }

  const Photographs& photographs_;
  const TileOptions& tile_;
  const ReferenceOptions& options_;
  const JobContext& context_;
  const std::unique_ptr<solver::Method> standard_ = solver::standard_method(),
                                        robust_method_ = solver::robust_method();
  std::unique_ptr<solver::Method> method_;   ///< the two, by block
  std::optional<Gloss> gloss_, last_gloss_;  ///< of readings as they are, and as the last round corrects them
  /// `method_` with the lobe of each, where there is one; `below_` is the level robust.
  const solver::Method *below_ = nullptr, *last_method_ = nullptr;
  std::optional<solver::BlockChoice> robust_;  ///< where the better of the two solves
  std::unique_ptr<Round> last_;
};

}  // namespace

Result<ReferenceFacts> solve_reference(const Photographs& photographs, const TileOptions& tile,
                                       const ReferenceOptions& options, const JobContext& context,
                                       const BandSink& sink) {
  Reference reference(photographs, tile, options, context);
  if (Result<void> ok = reference.choose_methods(); !ok) return std::move(ok).error();
  if (Result<void> ok = reference.find_candidates(); !ok) return std::move(ok).error();
  if (reference.facts.stages.any()) {
    if (Result<void> ok = reference.approach(); !ok) return std::move(ok).error();
  }
  if (reference.goes_beyond_robust()) {
    if (Result<void> ok = reference.hold_against_below(); !ok) return std::move(ok).error();
  }
  if (Result<void> ok = reference.finish(sink); !ok) return std::move(ok).error();
  return std::move(reference.facts);
}

}  // namespace weft::pipeline
