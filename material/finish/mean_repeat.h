// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/image.h"
#include "material/surface.h"

namespace weft::material {

/// The mean of a plane over all its repeats of `repeat_x` x `repeat_y` pixels. Places in the repeat are a
/// pixel wide at most.
class MeanRepeat {
 public:
  MeanRepeat(double repeat_x, double repeat_y);
  void add(int x, int y, double value);
  void add(View<const float> plane);

  double at(int x, int y) const;  ///< 0 where nothing was added
  double squares() const;         ///< sum over all that was added of its mean's square
  double places() const;          ///< that something was added to

 private:
  std::size_t column(int x) const;
  std::size_t row(int y) const;  ///< index of its first place

  double repeat_x_, repeat_y_;
  int columns_, rows_;
  std::vector<double> count_, sum_;
};

/// The share of the slopes' variance that comes again in every repeat, 0 to 1: of an analysis of variance by
/// place in the repeat, so that few repeats do not look alike by chance. Pixels without a solution are left
/// out.
double repeating_share(const Surface& surface, double repeat_x, double repeat_y);

}  // namespace weft::material
