// SPDX-License-Identifier: Apache-2.0
#include "pipeline/shifts.h"

#include <memory>
#include <span>
#include <utility>

#include "core/parallel.h"
#include "core/solve_record.h"
#include "pipeline/samples.h"
#include "pipeline/tile_reader.h"
#include "solver/method.h"
#include "solver/sample_tiles.h"

namespace weft::pipeline {
namespace {

// The sample tiles of photographs, each with readings of its own.
class Samples {
 public:
  Samples(const Photographs& photographs, std::span<const solver::ClothShift> shifts) {
    const TileOptions size = {.width = solver::kSampleTile, .height = solver::kSampleTile};
    for (const Rect& tile : solver::sample_tiles(photographs.size)) {
      readers_.push_back(std::make_unique<TileReader>(photographs, size, ReadAs::kTaken, shifts));
      inputs_.push_back(readers_.back()->read(tile));
    }
  }
  const std::vector<solver::TileInput>& inputs() const { return inputs_; }

 private:
  std::vector<std::unique_ptr<TileReader>> readers_;
  std::vector<solver::TileInput> inputs_;
};

// Residual of `fast`, rms over the albedo: mean over the pixels that have a solution.
double residual_of(const std::vector<solver::TileInput>& inputs, int threads) {
  const std::unique_ptr<solver::Method> method = solver::fast_method();
  std::vector<double> sums(inputs.size()), counts(inputs.size());
  parallel_for(inputs.size(), threads, [&](std::size_t i, int) {
    const SampleMaps maps = solve_sample(inputs[i], *method);
    for (int y = 0; y < maps.tile.height(); ++y) {
      for (int x = 0; x < maps.tile.width(); ++x) {
        if (maps.status(x, y) & (kNoSolution | kInvalidReading)) continue;
        sums[i] += double{maps.residual(x, y)};
        ++counts[i];
      }
    }
  });
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sum += sums[i];
    count += counts[i];
  }
  return count > 0 ? sum / count : 0;
}

bool worth_it(const ShotShift& shot) {
  return shot.measured.significant && shot.measured.cost_deg > kLeastCost_deg;
}

}  // namespace

Result<SessionShifts> register_shots(const Photographs& photographs, const JobContext& context) {
  const int threads = resolved_threads(context.threads);
  double residual = 0;
  SessionShifts result;
  {
    const Samples samples(photographs, {});
    solver::Registration measured = solver::register_shots(samples.inputs(), photographs.size, threads);
    result.found = measured.found;
    for (const solver::ShotRegistration& shot : measured.shots) result.shots.push_back({shot});
    residual = residual_of(samples.inputs(), threads);
  }
  if (context.stop.stop_requested()) return interrupted();
  bool any = false;
  std::vector<solver::ClothShift> shifts;
  for (ShotShift& shot : result.shots) {
    if (worth_it(shot)) shot.verdict = ShiftVerdict::kFlagged;
    any |= worth_it(shot);
    shifts.push_back(worth_it(shot) ? shot.measured.shift : solver::ClothShift());
  }
  if (!any || !result.found) return result;

  const double resampled = residual_of(Samples(photographs, shifts).inputs(), threads);
  if (resampled > (1 - kLeastGain) * residual) return result;
  result.corrections = std::move(shifts);
  for (ShotShift& shot : result.shots) {
    if (worth_it(shot)) shot.verdict = ShiftVerdict::kCorrected;
  }
  return result;
}

}  // namespace weft::pipeline
