// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/image.h"

namespace weft::material {

/// The mean of a plane over all its repeats of `repeat_x` x `repeat_y` pixels. Places in the repeat are a
/// pixel wide at most.
class MeanRepeat {
 public:
  MeanRepeat(double repeat_x, double repeat_y);
  void add(View<const float> plane);

  double at(int x, int y) const;  ///< 0 where nothing was added

 private:
  std::size_t column(int x) const;
  std::size_t row(int y) const;  ///< index of its first place

  double repeat_x_, repeat_y_;
  int columns_, rows_;
  std::vector<double> count_, sum_;
};

}  // namespace weft::material
