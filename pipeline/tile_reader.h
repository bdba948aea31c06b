// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/image.h"
#include "core/tiles.h"
#include "pipeline/photographs.h"

namespace weft::app {

/// The readings of one tile after another, made by one worker; shots of a shifted cloth
/// (Photographs::shifts) are resampled.
class TileReader {
 public:
  /// `tile` bounds the tiles to come. Where mosaics are to be read as RGB (`to_rgb`), `reach` pixels around
  /// a tile are read along with it, for demosaicing. `photographs` must outlive the reader.
  TileReader(const Photographs& photographs, const TileOptions& tile, int reach, bool to_rgb);

  /// Views of [k * planes + p] over the tile, valid until the next call. `tile.x0` is a multiple of
  /// kRowGroup.
  const std::vector<View<const float>>& read(Rect tile);

 private:
  bool shifted(std::size_t k) const;
  void read_mosaic(std::size_t k, Rect tile, View<float> out);
  void read_photograph(std::size_t k, Rect tile);
  void read_rgb(std::size_t k, Rect tile, const std::array<View<float>, 3>& rgb);
  std::array<double, 3> flux_of(std::size_t k) const;

  const Photographs* photographs_;
  bool to_rgb_;
  int reach_;
  Image<float> readings_, mosaic_, unmoved_;
  std::vector<View<const float>> views_;
};

}  // namespace weft::app
