// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/color_spaces.h"
#include "core/image/image.h"
#include "simulator/camera/camera_settings.h"

namespace weft::simulator {

/// The light of a frame, coarsely: the mean of each of at most 32 x 32 square cells of eight pixels or more.
class FrameLight {
 public:
  explicit FrameLight(Size frame);

  int columns() const { return means_.width(); }
  int rows() const { return means_.height(); }
  /// Pixels of a cell; those of the last column and row end with the frame.
  Rect cell(int column, int row) const;
  Rgb& mean(int column, int row) { return means_(column, row); }
  const Rgb& mean(int column, int row) const { return means_(column, row); }
  /// Between the middles of cells, linear; beyond the outermost as there.
  Rgb at(double x, double y) const;

 private:
  Size frame_;
  int side_;
  Image<Rgb> means_;
};

/// What a lens spreads of the light of a frame: `share` of it, each point's by a Gaussian of `spread` frame
/// diagonals. Light from beyond the frame counts as that within: an even frame gets `share` of its light
/// everywhere.
FrameLight veil_of(const VeilSettings& settings, const FrameLight& light);

}  // namespace weft::simulator
