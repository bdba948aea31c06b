// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "solver/uncertainty/model_sigma.h"

// The model's part of sigma by rows, a pixel or a cell of 2 x 2 pixels a lane. Whole row groups
// (core/image/image.h) may be read and written past the last one.

namespace weft::solver {

/// What is known of a cell by the pixel that speaks for it, one float each: 1 where that has a solution, and
/// then the square of its slope (the tangent of the angle from upright), up to 1.5 squared, its albedo, and
/// the square of its misfit, which is the residual over the albedo less what noise leaves of it.
enum CellFact : std::size_t { kCellPixels, kCellSlope2, kCellAlbedo, kCellMisfit2 };
inline constexpr std::size_t kCellFacts = 4;

/// Solved rows of pixels, from an even column on.
struct SolvedPixels {
  std::array<const float*, 3> normal;
  const float *residual, *albedo;
  const std::uint16_t* status;
  std::array<ResidualNoise, 2> noise;  ///< in even columns and in odd ones
};

/// The cells of two rows of pixels, from an even cell on. For even cells a pixel of the first row speaks, for
/// odd ones one of the second; it is in an odd column if `odd_column`. Without `has_noise` nothing misfits.
void see_cells(const std::array<SolvedPixels, 2>& rows, bool odd_column, bool has_noise, std::size_t count,
               const std::array<float*, kCellFacts>& facts);

/// Adds `cells` to `sums`.
void add_cells(const float* cells, std::size_t count, float* sums);

/// Mean slope squared and albedo of the 3 x 3 cells around each, of those with a solution; 0 where none has.
/// Each is there twice, for both columns of pixels. `columns` are sums of three rows of cells, from the cell
/// before the first on.
struct CellMeans {
  float *slope2, *albedo;
};
void mean_around(const std::array<const float*, kCellFacts>& columns, std::size_t count,
                 const CellMeans& means);

/// What a wider neighbourhood shows: means of CellFact, and the share that was solved from the start that
/// most readings agree on.
struct ModelSurroundings {
  float slope2 = 0, misfit2 = 0, robust = 0;
  float degrees_a_residual = 0;
};

/// Rms angle that the model's part of sigma comes to, degrees, of `count` pixels; 0 where there is no
/// solution. `within2` is null but for a preview: within_pixel2() of each.
void model_angles(const SolvedPixels& pixels, const CellMeans& cells, const float* within2,
                  const ModelSurroundings& around, const ModelTraits& traits, bool has_noise,
                  std::size_t count, float* angles_deg);

/// The model's standard deviation of an albedo that goes with such an angle: a radian of the one is about a
/// share of one of the other.
void model_albedo_sigma(const float* angles_deg, const float* albedo, std::size_t count, float* sigma);

}  // namespace weft::solver
