// SPDX-License-Identifier: Apache-2.0
#include "bench/base/measured_rig.h"

#include <cmath>

namespace weft::bench {

NearLights bench_lights(double mu, bool gains) {
  NearLights lights;
  const auto add_ring = [&](int count, double zenith_deg, double first_deg) {
    for (int i = 0; i < count; ++i) {
      const double azimuth = radians(first_deg + 360.0 * i / count), zenith = radians(zenith_deg);
      const Vec3 towards = {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth),
                            std::cos(zenith)};
      NearLight led;
      led.position_mm = 600.0 * towards;
      led.aim = -1.0 * towards;
      led.mu = mu;
      led.flux_rgb = {1.6e7, 3.2e7, 2.2e7};
      if (gains) led.log_gain_quadratic = {0.01 * i, 0.02, -0.01, 0.005, 0, 0.01};
      lights.leds.push_back(led);
    }
  };
  add_ring(4, 35, 0);
  add_ring(6, 62, 15);
  if (gains) {
    for (GainSpline& spline : lights.log_gain_rgb) {
      spline = {6, 4, {}};
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 6; ++i)
          spline.coefficients.push_back(-0.05 * ((i - 2.5) * (i - 2.5) + (j - 1.5) * (j - 1.5)));
      }
    }
  }
  return lights;
}

Size bench_size(double megapixels) {
  const double height = std::sqrt(megapixels * 1e6 / 1.5);
  const auto even = [](double v) { return 2 * static_cast<int>(std::lround(v / 2)); };
  return {even(1.5 * height), even(height)};
}

CameraModel bench_camera(Size size) {
  return overhead_camera(size, 600, 200.0 / size.width);
}

}  // namespace weft::bench
