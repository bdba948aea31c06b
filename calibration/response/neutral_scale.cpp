// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/neutral_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft::calibration {
namespace {

constexpr double kLeast_v = 0.01;
constexpr std::size_t kFewest = 5;

}  // namespace

double munsell_reflectance(double value) {
  const double v = value;
  return v * (1.1914 + v * (-0.22533 + v * (0.23352 + v * (-0.020484 + v * 0.00081939)))) / 100;
}

std::span<const MunsellPatch> munsell_scale() {
  static const std::array<MunsellPatch, 9> scale = [] {
    std::array<MunsellPatch, 9> patches = {};
    const std::array<double, 9> values = {9.5, 9, 8, 7, 6, 5, 4, 3, 2};
    for (std::size_t i = 0; i < values.size(); ++i) patches[i] = {values[i], munsell_reflectance(values[i])};
    return patches;
  }();
  return scale;
}

Result<ScaleCheck> check_scale(std::span<const double> reflectances,
                               std::span<const std::array<double, 3>> linear_v) {
  if (reflectances.size() != linear_v.size()) {
    return Error{ErrorKind::kUsage, "the grey scale does not fit", "scale",
                 fmt::format("{} patches were measured, {} reflectances are known", linear_v.size(),
                             reflectances.size()),
                 "name the reflectances of all patches in scale.toml"};
  }
  const auto place = [&](std::size_t i) {
    return static_cast<double>(i) / static_cast<double>(reflectances.size() - 1) - 0.5;
  };
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < reflectances.size(); ++i) {
    const auto& v = linear_v[i];
    if (std::min({v[0], v[1], v[2]}) >= kLeast_v && reflectances[i] > 0) used.push_back(i);
  }
  if (used.size() < kFewest) {
    return Error{ErrorKind::kBadData, "the grey scale cannot be used", "scale",
                 fmt::format("{} of its patches are above 1 percent of full scale and not full", used.size()),
                 "photograph it so that its white patch is at 80 percent"};
  }
  // Log light along the scale is level[channel] + slope x + bend x^2. The regressors are the same for all
  // channels, so that levels drop out with the means.
  const auto count = static_cast<double>(used.size());
  std::array<double, 3> mean = {};
  double x1 = 0, x2 = 0, s11 = 0, s12 = 0, s22 = 0, s1y = 0, s2y = 0;
  for (const std::size_t i : used) {
    x1 += place(i) / count;
    x2 += place(i) * place(i) / count;
    for (std::size_t c = 0; c < 3; ++c) mean[c] += std::log(linear_v[i][c] / reflectances[i]) / count;
  }
  for (const std::size_t i : used) {
    const double d1 = place(i) - x1, d2 = place(i) * place(i) - x2;
    for (std::size_t c = 0; c < 3; ++c) {
      const double y = std::log(linear_v[i][c] / reflectances[i]) - mean[c];
      s11 += d1 * d1;
      s12 += d1 * d2;
      s22 += d2 * d2;
      s1y += d1 * y;
      s2y += d2 * y;
    }
  }
  const double determinant = s11 * s22 - s12 * s12;
  const double slope = (s22 * s1y - s12 * s2y) / determinant, bend = (s11 * s2y - s12 * s1y) / determinant;
  const auto light = [&](std::size_t i) { return std::exp(place(i) * (slope + bend * place(i))); };
  ScaleCheck check;
  check.shading = light(reflectances.size() - 1) / light(0) - 1;
  for (std::size_t c = 0; c < 3; ++c) check.v_of_white[c] = std::exp(mean[c] - slope * x1 - bend * x2);
  double square = 0;
  for (std::size_t i = 0; i < reflectances.size(); ++i) {
    double off = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      off += linear_v[i][c] / (reflectances[i] * check.v_of_white[c] * light(i)) - 1;
    }
    check.off_percent.push_back(100 * off / 3);
  }
  for (const std::size_t i : used) square += check.off_percent[i] * check.off_percent[i];
  check.rms_percent = std::sqrt(square / count);
  return check;
}

}  // namespace weft::calibration
