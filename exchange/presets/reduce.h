// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image/image.h"

namespace weft::exchange {

/// What a pixel that stands for several is made of.
enum class Averaging {
  kMean,     ///< of the values
  kSquares,  ///< the root of the mean of their squares, as the variance of slopes adds up
  kSlopes,   ///< of -x / z and -y / z of normals: reduce_normals()
  kNearest   ///< the one in the middle: azimuths have no mean
};

/// A plane on the coarser grid of `to`, both covering the same rectangle: each pixel is the mean over its own
/// part of `from`, pixels on its borders by the share that lies inside. `to` is nowhere larger. The same for
/// any number of threads.
void reduce(View<const float> from, Averaging averaging, int threads, View<float> to);

/// The same of unit normals by their slopes, unit again. A z below 0.001 counts as 0.001.
void reduce_normals(const std::array<View<const float>, 3>& from, int threads,
                    const std::array<View<float>, 3>& to);

/// The mean of 0.2126 R + 0.7152 G + 0.0722 B.
double mean_luminance(const std::array<View<const float>, 3>& rgb);
/// The means of -x / z and -y / z.
std::array<double, 2> mean_slope(const std::array<View<const float>, 3>& normal);

}  // namespace weft::exchange
