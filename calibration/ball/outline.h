// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/image/image.h"

// The outline of a ball in photographs under several lamps: what all of them agree on.

namespace weft::calibration {

/// In pixels; (0, 0) is the centre of the upper left one, y points down.
struct Circle {
  double x = 0, y = 0, radius = 0;
};

/// A circle laid through the edge of a picture.
struct Outline {
  Circle circle;
  double sigma_px = 0;  ///< standard deviation of its centre, from how the edge scatters about it
  double support = 0;   ///< share of its directions in which there is such an edge, less what chance gives
  std::vector<std::array<double, 2>> edge;  ///< points of that edge, to a fraction of a pixel
};

/// The pictures that an outline is looked for in: the greatest value of all shots at each pixel, and the
/// mean.
struct SharedPictures {
  Image<float> greatest, mean;
  Image<float> median;  ///< as the shots are; of an even number the lower one
};
SharedPictures shared_pictures(std::span<const Image<float>> shots);

/// Circles that edges of the shared pictures vote for (Hough, along gradients), best first and at most 40, to
/// about a pixel. Radii reach from a 30th of the shorter side, 8 pixels at least, to 0.6 of it.
std::vector<Circle> voted_circles(const SharedPictures& shared);

/// The circle through the strongest edges near `start`: within `reach` of its radius and four pixels at
/// least, then closer. Tukey's weights. Nothing where too few directions have one.
std::optional<Outline> fitted_outline(const SharedPictures& shared, const Circle& start, double reach);

/// How far the lit part of an outline lies from `circle` in one shot, and how its edge scatters about that;
/// nothing where the shot does not show enough of it. Looks within a tenth of the radius, and eight pixels at
/// least.
struct OutlineShift {
  double x = 0, y = 0, scatter_px = 0;
};
std::optional<OutlineShift> outline_shift(const Image<float>& shot, const Circle& circle);

}  // namespace weft::calibration
