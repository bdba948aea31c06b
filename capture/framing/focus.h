// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "core/image/raw_frame.h"

namespace weft::capture {

/// What a photosite's noise is, in counts: that of s counts of light has the variance
/// s / electrons_per_count + read_noise_counts^2.
struct PhotositeNoise {
  double electrons_per_count = 1;
  double read_noise_counts = 0;
};

/// How sharp a photograph is, by place.
struct FocusMap {
  static constexpr int kColumns = 8, kRows = 6;
  using Cells = std::array<double, kColumns * kRows>;

  /// Row by row from the upper left; NaN where a cell is too dark, or too full, to tell.
  Cells cells = {};
  double score = 0;  ///< mean of the cells; NaN where none can tell
};

/// The energy of the finest gradients of green over its squared mean: Tenengrad (Tenenbaum 1970), on the raw
/// mosaic. Green photosites lie on a lattice that is turned by 45 degrees, on which Sobel's operator is
/// taken, so that every one of them counts and the two rows' greens may differ in gain. Noise adds 24/64 of
/// its variance, which is taken off; without `noise` it stays in, and dark photographs look sharper than they
/// are.
///
/// It says nothing of an absolute sharpness: only photographs of one cloth by one light can be compared.
FocusMap focus_of(const RawFrame& frame, const std::optional<PhotositeNoise>& noise);

/// Where a photograph stands among those of one turn of the focus ring.
struct FocusStanding {
  std::vector<double> scores;     ///< of the last kKept photographs, this one last
  std::size_t best = 0;           ///< index of the sharpest among them
  FocusMap::Cells relative = {};  ///< each cell over the sharpest that it was
  /// How much sharper the right edge is than the left, and the lower than the upper, over what each was at
  /// best: 0.1 is 10 percent. Where both edges are sharpest in the same photograph, the camera looks straight
  /// at the cloth. None from fewer than three photographs or half of the cells.
  std::optional<double> more_right, more_below;
};

/// The photographs of one turn of the focus ring, one cloth by one light.
class FocusSeries {
 public:
  static constexpr std::size_t kKept = 30;

  FocusStanding add(const FocusMap& map);

 private:
  std::deque<FocusMap> maps_;
};

}  // namespace weft::capture
