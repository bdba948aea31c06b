// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/grey_oracle.h"

#include <algorithm>
#include <cmath>

#include "bench/oracles/oracle_rig.h"

namespace weft::test {
namespace {

constexpr double kGreys[] = {0.878, 0.767, 0.576, 0.420, 0.293, 0.193, 0.117, 0.064, 0.030};
constexpr double kPitch_mm = 18;
constexpr double kBrightest_v = 0.8;

}  // namespace

GreyCapture greys_of(PaperRig rig, const GreyErrors& errors) {
  Random random(errors.seed);
  const double x = random.normal(), y = random.normal();
  rig.sheets = {{errors.tilt_deg * std::hypot(x, y),
                 degrees(std::atan2(y, x)),
                 0,
                 {0, 0, errors.height_mm * random.normal()}}};
  rig.delta = errors.delta * random.normal();
  rig.log_albedo = {};
  GreyCapture capture;
  double brightest = 0;
  for (const double grey : kGreys) {
    calibration::GreyPatch& patch = capture.patches.emplace_back();
    const auto place = static_cast<double>(capture.patches.size()) - 5;
    patch.x_px = (rig.width_px - 1) / 2.0 + place * kPitch_mm / rig.mm_per_pixel;
    patch.y_px = (rig.height_px - 1) / 2.0;
    patch.reflectance = grey;
    const double true_grey = grey * (1 + errors.reflectance * random.normal());
    for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
      std::array<double, 3>& reading = patch.reading_rgb.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const double white = rig.reading(0, k, c, patch.x_px, patch.y_px);
        const double stray = errors.stray * random.normal(), noise = errors.noise * random.normal();
        reading[c] = white * (true_grey * (1 + noise) + stray);
        brightest = std::max(brightest, reading[c]);
      }
    }
  }
  capture.full_reading.assign(rig.lights.leds.size(), brightest / kBrightest_v);
  for (calibration::GreyPatch& patch : capture.patches) {
    for (std::array<double, 3>& reading : patch.reading_rgb) {
      for (double& r : reading) r *= 1 + errors.bend * r * kBrightest_v / brightest;
    }
  }
  return capture;
}

}  // namespace weft::test
