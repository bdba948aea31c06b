// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/solved_relief.h"

#include <utility>

#include "solver/height/height.h"

namespace weft::solve {

SolvedRelief::SolvedRelief(const Photographs& photographs, SolvedFrame frame,
                           const ReferenceOptions& reference, int threads)
    : solved(std::move(frame)), options(reference), photographs_(photographs), threads_(threads) {}

Result<std::shared_ptr<SolvedRelief>> SolvedRelief::of(const Photographs& photographs, SolvedFrame solved,
                                                       const ReferenceOptions& options, int threads) {
  std::shared_ptr<SolvedRelief> relief(new SolvedRelief(photographs, std::move(solved), options, threads));
  if (Result<void> ok = relief->integrate(); !ok) return std::move(ok).error();
  return relief;
}

Result<void> SolvedRelief::integrate() {
  solver::HeightOptions height_options;
  height_options.threads = threads_;
  Result<solver::Height> height = solver::height_from_normals(
      {solved.normal.plane(0), solved.normal.plane(1), solved.normal.plane(2)}, {}, height_options);
  if (!height) return std::move(height).error();
  facts.slope_residual_rms = height->slope_residual_rms;
  height_ = std::move(height->height_mm);
  Result<solver::Relief> relief = solver::Relief::of(height_.plane(), 1);
  if (!relief) return std::move(relief).error();
  relief_ = *relief;
  return {};
}

LightCorrection SolvedRelief::correction_of(const LightStages& stages) const {
  return {
      photographs_, solved, relief_, {stages, options.directions, options.steps, options.reach_px}, threads_};
}

LightCorrection SolvedRelief::early_correction() const {
  return {photographs_,
          solved,
          relief_,
          {facts.stages, options.early_directions, options.early_steps, options.reach_px},
          threads_};
}

}  // namespace weft::solve
