// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/image/image.h"
#include "solve/photographs/photographs.h"
#include "solver/kernels/model_angles.h"
#include "solver/left_out/block_choice.h"
#include "solver/uncertainty/block_facts.h"

namespace weft::solve {

/// Solved maps of a band of rows, (0, 0) at its corner.
struct SolvedRows {
  std::array<View<const float>, 3> normal;
  View<const float> residual;
  View<const std::uint16_t> status;
  View<const float> albedo;            ///< of each photosite of a mosaic, or of green
  View<const float> sigma_normal_deg;  ///< by noise
};

/// The model's part of sigma (solver/kernels/model_angles.h) over a frame that is solved band by band: of
/// each pixel by itself, the 3 x 3 cells of 2 x 2 pixels around it, as far as they lie in its band, and a
/// block of 64 columns and the band's rows. One pixel speaks for a cell. What lies within the pixels of a
/// preview is told by their neighbours in the band. The same bytes for any number of threads.
class ModelPart {
 public:
  /// Bands have `band_rows` rows, an even number of which 256 is a multiple, but for the last. `robust` says
  /// where the level robust solved; null: nowhere. It and `photographs` must outlive this; photographs of a
  /// preview are RGB.
  ModelPart(const Photographs& photographs, int band_rows, const solver::ModelTraits& traits,
            const solver::BlockChoice* robust, int threads, bool looks_at_blocks = false);

  /// Takes in the next band.
  void gather(Rect band, const SolvedRows& solved);

  /// What the blocks of all bands so far showed, row by row; empty unless they are looked at.
  const std::vector<solver::BlockFacts>& facts() const { return facts_; }

  /// Fills the angle for `rows` of the frame, in degrees, and the albedo's share of R, G, B. They begin
  /// solver::kDemosaicReach rows above the gathered band at most. All views are as large as `rows`.
  void fill(Rect rows, const std::array<View<const float>, 3>& albedo, View<float> model_normal_deg,
            const std::array<View<float>, 3>& model_albedo) const;

 private:
  struct Block {
    // By row and column of the filter.
    std::array<std::array<solver::ResidualNoise, 2>, 2> noise;
    solver::ModelSurroundings around;
  };
  // Sums and means of a row of cells.
  struct CellRow {
    explicit CellRow(int cells);
    Image<float> sums, means;
  };

  void set_lights(int y0);
  int column_of(std::size_t block) const;
  solver::SolvedPixels pixels_at(int x, int y, const SolvedRows& solved) const;
  void see_row(int cell_y, const SolvedRows& solved);
  void sum_blocks(int cell_rows);
  void see_within(const SolvedRows& solved);
  void angles_of(int cell_y, int cell_rows, const SolvedRows& solved, CellRow& row);
  void look_at_blocks(const SolvedRows& solved);

  const Photographs& photographs_;
  Planes planes_;
  bool has_noise_;
  solver::ModelTraits traits_;
  const solver::BlockChoice* robust_;
  int threads_;
  bool looks_at_blocks_;
  Image<float> cells_;    ///< a plane a solver::CellFact over the band, with an empty cell before each row
  Image<float> angles_;   ///< the last rows of the band before, then those of the band
  Image<float> within2_;  ///< of a preview, over the band
  int first_ = 0;         ///< the frame's row that is the first of angles_
  std::vector<Block> blocks_;
  std::vector<solver::BlockFacts> facts_;
};

}  // namespace weft::solve
