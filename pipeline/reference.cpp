// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reference.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/vec.h"
#include "pipeline/samples.h"
#include "solver/height/height.h"

namespace weft::pipeline {
namespace {

// Keeps a solve in memory, and by how much it turned the normals of the one before, if there is one.
class FrameKeeper {
 public:
  FrameKeeper(const Photographs& photographs, const SolvedFrame* before)
      : planes_(photographs.planes()), before_(before) {
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
    for (int x = 0; before_ != nullptr && x < band.rows.width(); ++x) {
      const Vec3 before = {before_->normal(x, row, 0), before_->normal(x, row, 1),
                           before_->normal(x, row, 2)};
      turned_deg_ += angle_deg(before, {band.normal[0](x, y), band.normal[1](x, y), band.normal[2](x, y)});
    }
    for (int c = 0; c < 3; ++c) {
      std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), band.rows.width(),
                  frame.normal.plane(c).row(row));
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
  const SolvedFrame* before_;
  double turned_deg_ = 0;
};

// One round: the frame's relief, its light, and a solve of what is left of the readings.
class Round {
 public:
  Round(const Photographs& photographs, const SolvedFrame& solved, LightCorrectionOptions options,
        int threads)
      : photographs_(&photographs), solved_(&solved), options_(options), threads_(threads) {}

  Result<void> integrate() {
    Stopwatch watch;
    solver::HeightOptions options;
    options.threads = threads_;
    Result<solver::Height> height = solver::height_from_normals(
        {solved_->normal.plane(0), solved_->normal.plane(1), solved_->normal.plane(2)}, {}, options);
    if (!height) return std::move(height).error();
    height_ = std::move(height->height_mm);
    Result<solver::Relief> relief = solver::Relief::of(height_.plane(), 1);
    if (!relief) return std::move(relief).error();
    relief_ = *relief;
    facts.height_seconds = watch.lap();
    return {};
  }

  Result<double> solve(const solver::Method& method, const TileOptions& tile, const JobContext& context,
                       const BandSink& sink, BandOptions options) {
    Stopwatch watch;
    LightCorrection correction(*photographs_, *solved_, relief_, options_, threads_);
    reach_is_capped = correction.shadow_reach_is_capped();
    options.correction = &correction;
    Result<double> waited = solve_bands(*photographs_, method, tile, context, sink, options);
    facts.light_seconds = correction.seconds();
    facts.solve_seconds = watch.lap() - correction.seconds();
    return waited;
  }

  ReferenceRound facts;
  bool reach_is_capped = false;

 private:
  const Photographs* photographs_;
  const SolvedFrame* solved_;
  LightCorrectionOptions options_;
  int threads_;
  Image<float> height_;
  solver::Relief relief_;
};

}  // namespace

Result<ReferenceFacts> solve_reference(const Photographs& photographs, const TileOptions& tile,
                                       const ReferenceOptions& options, const JobContext& context,
                                       const BandSink& sink) {
  ReferenceFacts facts;
  const auto quick = solver::robust_method(), exact = solver::exact_method();
  Result<solver::Gates> gates =
      measure_gates(solve_samples(photographs, *solver::standard_method(), context.threads));
  if (!gates) return std::move(gates).error();
  facts.gates = *gates;
  facts.stages = options.force_stages ? LightStages{true, true}
                                      : LightStages{gates->shadows(), gates->interreflection()};
  if (!facts.stages.shadows && !facts.stages.interreflection) {
    const Result<double> waited =
        solve_bands(photographs, *exact, tile, context, sink,
                    {.tally = &facts.tally, .model = solver::ModelTraits{.is_robust = true}});
    if (!waited) return waited.error();
    facts.waited_seconds = *waited;
    return facts;
  }

  FrameKeeper first(photographs, nullptr);
  if (const auto solved = solve_bands(photographs, *quick, tile, context, std::ref(first)); !solved) {
    return solved.error();
  }
  SolvedFrame frame = std::move(first.frame);
  const LightCorrectionOptions light = {facts.stages, options.rays, options.reach_px};
  for (bool settled = false, done = false; !done;) {
    done = settled || static_cast<int>(facts.rounds.size()) + 1 >= options.most_rounds;
    Round round(photographs, frame, light, context.threads);
    if (Result<void> ok = round.integrate(); !ok) return std::move(ok).error();
    FrameKeeper next(photographs, &frame);
    const BandOptions last = {.tally = &facts.tally,
                              .model = solver::ModelTraits{true, facts.stages.interreflection}};
    const Result<double> waited = done ? round.solve(*exact, tile, context, sink, last)
                                       : round.solve(*quick, tile, context, std::ref(next), {});
    if (!waited) return waited.error();
    if (done) {
      facts.waited_seconds = *waited;
    } else {
      round.facts.turned_deg = next.mean_turn_deg();
      settled = round.facts.turned_deg < options.settled_deg;
    }
    facts.rounds.push_back(round.facts);
    facts.shadow_reach_is_capped |= round.reach_is_capped;
    if (!done) frame = std::move(next.frame);
  }
  return facts;
}

}  // namespace weft::pipeline
