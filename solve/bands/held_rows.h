// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/image/image.h"
#include "solve/bands/bands.h"

namespace weft::solve {

/// The rows of maps that a step after the solve looks back and ahead at.
class HeldRows {
 public:
  explicit HeldRows(int width);

  /// A band with the rows that follow those before it.
  void append(const MapBand& band);
  /// Drops what lies above `row` of the image.
  void forget_above(int row);

  int first() const { return first_; }  ///< row of the image
  int end() const { return end_; }      ///< the first that some map does not have yet
  /// All maps over rows of the image that are held, none of them lagging. Valid until the next append().
  MapBand of(Rect rows) const;
  MapBand all() const { return of({0, first_, maps_.width(), end_}); }

 private:
  Image<float> maps_;
  Image<std::uint16_t> status_;
  bool has_model_ = false;
  int first_ = 0, end_ = 0;
};

}  // namespace weft::solve
