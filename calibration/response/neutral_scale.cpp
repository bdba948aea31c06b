// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/neutral_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft::calibration {
namespace {

constexpr double kLeast_v = 0.01;
constexpr std::size_t kFewest = 4;

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
  // Where the line along the scale is the same for all channels, levels drop out as means.
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
  const auto count = static_cast<double>(used.size());
  double mean_place = 0;
  for (const std::size_t i : used) mean_place += place(i) / count;
  std::array<double, 3> mean = {};
  double xy = 0, xx = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    for (const std::size_t i : used) mean[c] += std::log(linear_v[i][c] / reflectances[i]) / count;
    for (const std::size_t i : used) {
      const double x = place(i) - mean_place;
      xx += x * x;
      xy += x * (std::log(linear_v[i][c] / reflectances[i]) - mean[c]);
    }
  }
  const double slope = xy / xx;
  ScaleCheck check;
  check.shading = std::expm1(slope);
  for (std::size_t c = 0; c < 3; ++c) check.v_of_white[c] = std::exp(mean[c] - slope * mean_place);
  double square = 0;
  for (std::size_t i = 0; i < reflectances.size(); ++i) {
    double off = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      off += linear_v[i][c] / (reflectances[i] * check.v_of_white[c] * std::exp(slope * place(i))) - 1;
    }
    check.off_percent.push_back(100 * off / 3);
  }
  for (const std::size_t i : used) square += check.off_percent[i] * check.off_percent[i];
  check.rms_percent = std::sqrt(square / count);
  return check;
}

}  // namespace weft::calibration
