// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/vec.h"
#include "core/image/image.h"

namespace weft::material {

/// Slopes as a Surface has them: to the right and up the picture.
struct TestSlopes {
  Image<float> right, up;
};

/// Which way a test weave is irregular.
struct WeaveFaults {
  double turn_deg = 0;
  double jitter = 0;  ///< rms of each yarn's place, in pitches
};

TestSlopes level_slopes(Size size);
/// Differences over a pixel of a plain weave of round yarns with creases between them, `pitch_px` from yarn
/// to yarn, mean slope about 22 degrees.
TestSlopes weave_slopes(Size size, double pitch_px, const WeaveFaults& faults = {});
/// Adds noise of an rms angle (of a level normal) to both slopes.
void add_noise(TestSlopes& slopes, double sigma_deg, std::uint64_t seed);
/// What was at (x, y) is at (x + dx, y + dy), around the borders.
TestSlopes moved(const TestSlopes& slopes, int dx, int dy);
bool same_floats(const Image<float>& a, const Image<float>& b);

}  // namespace weft::material
