// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/image/image.h"

namespace weft::solver {

/// A plane of floats with a frame of zeros, so that neighbours may be read without asking whether they are
/// there.
class PaddedPlane {
 public:
  PaddedPlane() = default;
  explicit PaddedPlane(Size size) : image_({size.width + 3, size.height + 3}), view_(view_of(image_, size)) {}
  /// Row -1 <= y < height + 2, of which columns -1 <= x < width + 2 may be read.
  float* row(int y) { return view_.row(y); }
  const float* row(int y) const { return view_.row(y); }
  View<float> view() { return view_; }
  Size size() const { return view_.size(); }

 private:
  static View<float> view_of(Image<float>& image, Size size) {
    return image.plane().crop({1, 1, 1 + size.width, 1 + size.height});
  }
  Image<float> image_;
  View<float> view_;
};

/// One level of a pyramid for sum over neighbours of w (h(here) - h(there)) = source(here).
struct GridLevel {
  GridLevel() = default;
  explicit GridLevel(Size size)
      : left_weight(size), upper_weight(size), source(size), height(size), scratch(size) {}
  Size size() const { return height.size(); }

  PaddedPlane left_weight, upper_weight;  ///< towards the left and the upper neighbour; 0 where there is none
  PaddedPlane source, height, scratch;
};

/// Levels below `finest`, whose sizes are halved until one pixel is left. An edge there weighs half the sum
/// of the two edges it stands for: right for open ground and for a line of single pixels alike, and no edge
/// means no way.
void add_coarser_levels(std::vector<GridLevel>& levels, int threads);

/// height += damping * (source - what the heights give) / diagonal: a Jacobi step, in whatever order.
void relax(GridLevel& level, float damping, int threads);
/// The same from height 0.
void relax_from_zero(GridLevel& level, float damping, int threads);
/// scratch = source - what the heights give.
void find_residual(GridLevel& level, int threads);
/// coarse.source = transpose of add_from_coarse, of fine.scratch.
void restrict_residual(const GridLevel& fine, GridLevel& coarse, int threads);
/// fine.height += coarse.height, interpolated bilinearly between cells; a neighbour without an edge is taken
/// as equal, so that nothing leaks over a gap.
void add_from_coarse(const GridLevel& coarse, GridLevel& fine, int threads);

/// What the heights `h` give at row y: sum of w (h(here) - h(there)).
void apply_row(const GridLevel& level, const PaddedPlane& h, int y, float* out);

}  // namespace weft::solver
