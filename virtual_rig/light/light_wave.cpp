// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/light_wave.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/base/vec.h"

namespace weft::virtual_rig {
namespace {

/// sin(x) / x.
double sinc(double x) {
  return x == 0 ? 1 : std::sin(x) / x;
}

/// Periods that pulses were on for, of so many.
double periods_on(double periods, double duty) {
  const double whole = std::floor(periods);
  return duty * whole + std::min(periods - whole, duty);
}

}  // namespace

double mean_light(const LightWave& wave, double from_s, double length_s) {
  const double begun = wave.hertz * from_s, periods = wave.hertz * length_s;
  const double from = begun - std::floor(begun);
  if (!wave.duty) return 1 + wave.depth * std::sin(2 * kPi * (from + periods / 2)) * sinc(kPi * periods);
  const double on = (periods_on(from + periods, *wave.duty) - periods_on(from, *wave.duty)) / periods;
  return (1 - wave.depth * (1 - on)) / (1 - wave.depth * (1 - *wave.duty));
}

std::vector<double> light_by_row(const LightWave& wave, const CameraExposure& exposure, int rows) {
  const double opened_s = std::chrono::duration<double>(exposure.opened.time_since_epoch()).count();
  const double row_s = rows > 1 ? exposure.readout_s / (rows - 1) : 0;
  std::vector<double> light;
  for (int y = 0; y < rows; ++y)
    light.push_back(mean_light(wave, opened_s + y * row_s, exposure.exposure_us * 1e-6));
  return light;
}

}  // namespace weft::virtual_rig
