// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "solver/left_out/block_choice.h"
#include "solver/left_out/blocks.h"

// Left-out light: each light in turn is left out of a solve, and its reading is predicted from the others.
// Needs no truth. Cannot see what all lights share: a common scale, a slow common tilt.

namespace weft::solver {

/// Lights are left out in so many turns at most, so that many lights cost no more than few: light k in turn
/// k modulo the turns.
inline constexpr std::size_t kMostTurns = 12;
std::size_t turns_of(std::size_t lights);

/// What leaving lights out told of the pixels of some patches. Values are readings over strength, [pixel *
/// lights + light], pixels patch by patch and row by row; NaN where a reading or its prediction is missing.
struct LeftOut {
  BlockGrid grid;
  std::size_t lights = 0;
  std::vector<Patch> patches;
  std::vector<float> scale;    ///< by pixel: the third brightest of ten readings
  std::vector<float> reading;  ///< as taken
  std::vector<float> error;    ///< reading less prediction
  std::vector<float> noise;    ///< sigma that noise alone gives the error; NaN where it is not known
  /// By pixel: the jackknife's sigma of the normal, degrees, by how far it turns when a turn's lights are
  /// left out; NaN where a turn has no solution.
  std::vector<float> turned_deg;
};

/// Sigma of reading k less its prediction by the lights of other turns, from the noise of all: `directions`
/// and `variances` by light, NaN where a reading is not used. NaN where the others do not span a normal.
void left_out_noise(std::span<const Vec3> directions, std::span<const double> variances,
                    std::span<float> sigma);

/// How much smaller the errors of one variant are than those of another, in shares of the brightness.
struct Gain {
  double mean = 0;   ///< of |error of a| - |error of b|, large errors cut to a common limit
  double sigma = 0;  ///< of the mean, from the scatter of patches
  int patches = 0;

  /// Whether b is kept over a: better by more than its own sigma.
  bool keeps() const;
};

/// Fewer patches say nothing of a block by themselves.
inline constexpr int kLeastPatches = 4;

struct Comparison {
  BlockGrid grid;
  Gain frame;
  std::vector<Gain> blocks;  ///< of the grid

  /// 1 where the block keeps b; blocks of too few patches follow the frame.
  BlockChoice choice() const;
};

/// b against a over the same patches, lights and pixels.
Comparison compare(const LeftOut& a, const LeftOut& b);

/// The errors of one light, or of all, over lit readings: those from kShadowShare of the brightness.
/// Relative to the reading; NaN where there are none.
struct LeftOutError {
  double median = 0;        ///< of |error| / reading
  double rms = 0;           ///< of error / brightness, each cut to 1
  double noise_median = 0;  ///< the same two as noise alone would give them; NaN where it is not known
  double noise_rms = 0;
  std::size_t readings = 0;
};
LeftOutError error_of_light(const LeftOut& left_out, std::size_t light);
LeftOutError error_of_all(const LeftOut& left_out);

/// The jackknife's sigma of a normal of which each turn's solve is given: the root of (T - 1) / T times the
/// sum of their squared distances from their mean, degrees (Efron, 1982). NaN of fewer than two.
double jackknife_deg(std::span<const Vec3> normals);

}  // namespace weft::solver
