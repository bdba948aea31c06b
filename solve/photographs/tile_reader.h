// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/image/tiles.h"
#include "solve/photographs/photographs.h"
#include "solver/method.h"

namespace weft::solve {

/// What becomes of mosaics as they are read. Developed photographs stay as they are.
enum class ReadAs {
  kTaken,  ///< one plane
  kRgb,    ///< demosaiced before they are solved: three
};

/// The readings of one tile after another, made by one worker.
class TileReader {
 public:
  /// `tile` bounds the tiles to come. The photographs must outlive the reader.
  TileReader(const Photographs& photographs, const TileOptions& tile, ReadAs as = ReadAs::kTaken);

  Planes planes() const { return planes_; }
  /// A tile as methods want it, its readings valid until the next call. `tile.x0` is a multiple of
  /// kRowGroup.
  solver::TileInput read(Rect tile);

 private:
  void read_frames(const Frames& frames, std::size_t first_plane, Rect tile);
  void read_rgb(const Frames& frames, std::size_t k, Rect tile, std::span<const View<float>> rgb);
  std::array<double, 3> flux_of(std::size_t k) const;

  const Photographs* photographs_;
  Planes taken_, planes_;
  Image<float> readings_, mosaic_;  // readings_: [(state * lights + k) * planes + p]
  std::vector<View<const float>> views_;
};

}  // namespace weft::solve
