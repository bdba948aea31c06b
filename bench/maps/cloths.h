// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <ctime>

#include "core/image/image.h"
#include "simulator/geometry/geometry_settings.h"

namespace weft::bench {

/// A surface of the simulator sampled at the centres of pixels: what maps are measured against.
struct SampledCloth {
  double mm_per_pixel = 0;
  Image<float> height_mm;
  Image<float> normal;  ///< X right, Y up, Z to the camera

  std::array<View<const float>, 3> normals() const {
    return {normal.plane(0), normal.plane(1), normal.plane(2)};
  }
};
SampledCloth sampled(const simulator::GeometrySettings& geometry, Size size, double mm_per_pixel,
                     int threads);

/// A plain weave of a family, ten pixels of 0.05 mm a yarn.
inline constexpr double kClothPitch_mm = 0.05;
simulator::GeometrySettings cloth_of(simulator::Family family);
/// The same laid in waves and folds up to 1.5 mm high.
simulator::GeometrySettings draped_cloth(simulator::Family family);

struct HeightDifference {
  double rms = 0, largest = 0;
};

/// The difference of two height maps in pixels, after the plane that fits it best.
HeightDifference height_difference(const Image<float>& a, const Image<float>& b, double mm_per_pixel);

/// Pixels from the 1st to the 99th percentile of a height map.
double relief(const Image<float>& height_mm, double mm_per_pixel);

/// Processor time of all threads that body() took, in seconds: what a busy machine does not change much.
template <typename Body>
double processor_seconds(const Body& body) {
  const std::clock_t begin = std::clock();
  body();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace weft::bench
