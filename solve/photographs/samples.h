// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solve/photographs/photographs.h"
#include "solver/gates/gates.h"
#include "solver/method.h"

namespace weft::solve {

/// What a method makes of the sample tiles (solver/sample_tiles.h), without their surroundings: the albedo
/// of a mosaic is that of each photosite in its own colour, of RGB that of green.
struct SampleMaps {
  Rect tile;
  Image<float> normal;            ///< X, Y, Z
  Image<float> albedo;            ///< 1 plane
  Image<float> sigma_normal_deg;  ///< 1 plane
  Image<float> residual;          ///< 1 plane
  Image<std::uint16_t> status;
  std::int64_t readings = 0, shadowed = 0;  ///< as of solver::SolvedSample

  solver::SolvedSample sample() const;
};

/// One tile, without its count of readings.
SampleMaps solve_sample(const solver::TileInput& input, const solver::Method& method);

/// Solves the sample tiles on `threads` threads.
std::vector<SampleMaps> solve_samples(const Photographs& photographs, const solver::Method& method,
                                      int threads);

/// The gates of a solve, from its samples. Where the scale of the albedo is relative, it is taken for 1.
/// `specular` is limited where highlights outshine the cloth (solver/diagnosis/highlights.h); what else has
/// the bit are holes, which no gate is shut for.
Result<solver::Gates> measure_gates(const std::vector<SampleMaps>& samples, const Photographs& photographs);

}  // namespace weft::solve
