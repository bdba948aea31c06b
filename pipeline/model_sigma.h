// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/image.h"
#include "pipeline/photographs.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::pipeline {

/// Solved maps of a band of rows, (0, 0) at its corner.
struct SolvedRows {
  std::array<View<const float>, 3> normal;
  View<const float> residual;
  View<const std::uint16_t> status;
  View<const float> albedo;  ///< of each photosite of a mosaic, or of green
};

/// The model's part of sigma (solver/uncertainty/model_sigma.h) over a frame that is solved band by band. One
/// pixel speaks for each cell of 2 x 2. The evidence of a cell is that of the 3 x 3 cells around it, as far
/// as they are solved when its turn comes; its wider neighbourhood is a block of 64 columns and a band's
/// rows. What lies within the pixels of a preview is told for each, by its four neighbours in the band. The
/// same bytes for any number of threads.
class ModelPart {
 public:
  /// Bands have `band_rows` rows, an even number, but for the last. `photographs` must outlive this; those of
  /// a preview are RGB.
  ModelPart(const Photographs& photographs, int band_rows, const solver::ModelTraits& traits, int threads);

  /// Takes in the next band.
  void gather(Rect band, const SolvedRows& solved);

  /// Fills the angle for `rows` of the frame, in degrees, and the albedo's share of R, G, B. They begin
  /// solver::kDemosaicReach rows above the gathered band at most. All views are as large as `rows`.
  void fill(Rect rows, const std::array<View<const float>, 3>& albedo, View<float> model_normal_deg,
            const std::array<View<float>, 3>& model_albedo) const;

 private:
  // Of the pixels with a solution.
  enum Sum { kPixels, kSlope2, kAlbedo, kShaded, kMisfit2, kSums };
  using Sums = std::array<float, kSums>;
  struct Block {
    std::array<solver::ResidualNoise, 3> noise;  ///< by channel
    float degrees_a_residual = 0;
    float slope2 = 0, misfit2 = 0;  ///< means, as of solver::ModelEvidence
  };

  void set_blocks(Rect band);
  Sums seen_at(int cell_x, int cell_y, int frame_y0, const SolvedRows& solved) const;
  void sum_blocks(int first_row);
  void see_within(const SolvedRows& solved);
  void angles_at(int row, std::vector<float>& angles) const;
  float angle_of(const Sums& around, const Block& block) const;

  const Photographs& photographs_;
  Planes planes_;
  bool has_noise_;
  solver::ModelTraits traits_;
  int threads_;
  Image<float> cells_;         ///< a plane a Sum: the last rows of the band before, then those of the band
  int first_ = 0;              ///< the frame's row of cells that is the first of cells_
  int known_ = 0;              ///< rows of cells_ that are filled
  Image<float> within2_deg2_;  ///< of a preview, over the band
  std::vector<Block> blocks_;
};

}  // namespace weft::pipeline
