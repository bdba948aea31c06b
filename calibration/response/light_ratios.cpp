// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/light_ratios.h"

#include <algorithm>
#include <cmath>

namespace weft::calibration {
namespace {

double linear(const Moments& moments, std::size_t channel, const TransferCurve& curve) {
  const auto [a, b] = curve.linearity[channel];
  const Moments m = shifted(moments, curve.offset);
  return m.v + a * m.v2 + b * m.v3;
}

// Mean of v over the squares that all exposures of a LED hold.
std::optional<double> mean_of_common(const std::vector<TimedLight>& led, const TimedLight& at,
                                     std::size_t c) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < at.light->blocks.size(); ++i) {
    const bool everywhere = std::all_of(
        led.begin(), led.end(), [&](const TimedLight& l) { return l.light->blocks[i][c].photosites > 0; });
    if (!everywhere) continue;
    sum += at.light->blocks[i][c].v;
    ++count;
  }
  if (count == 0) return {};
  return sum / count;
}

}  // namespace

std::optional<std::array<double, 3>> light_by_channel(const BlockLight& light, const TransferCurve& curve) {
  std::array<double, 3> sum = {};
  int count = 0;
  for (const auto& block : light.blocks) {
    if (block[0].photosites == 0 || block[1].photosites == 0 || block[2].photosites == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += linear(block[c], c, curve);
    ++count;
  }
  if (count == 0) return {};
  for (double& s : sum) s /= count;
  return sum;
}

std::optional<double> light_ratio(const BlockLight& light, const BlockLight& to, const TransferCurve& curve) {
  // With photon noise alone the best estimate of a ratio is the ratio of sums.
  double sum = 0, to_sum = 0;
  for (std::size_t i = 0; i < light.blocks.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Moments &a = light.blocks[i][c], &b = to.blocks[i][c];
      if (a.photosites == 0 || b.photosites == 0) continue;
      sum += linear(a, c, curve);
      to_sum += linear(b, c, curve);
    }
  }
  if (!(sum > 0) || !(to_sum > 0)) return {};
  return sum / to_sum;
}

std::optional<DarkLevel> level_at_no_exposure(std::span<const std::vector<TimedLight>> leds,
                                              double time_error) {
  // A line through each LED and channel, level and slope; the levels are then joined.
  double sum = 0, weight = 0, chi_square = 0, freedom = -1;
  std::vector<std::pair<double, double>> levels;  // with variances
  for (const std::vector<TimedLight>& led : leds) {
    for (std::size_t c = 0; c < 3; ++c) {
      double w = 0, x = 0, y = 0, xx = 0, xy = 0;
      int count = 0;
      for (const TimedLight& at : led) {
        const std::optional<double> v = mean_of_common(led, at, c);
        if (!v) continue;
        const double t = at.exposure_us, one = 1 / std::pow(time_error * *v + 1e-6, 2);
        w += one;
        x += one * t;
        y += one * *v;
        xx += one * t * t;
        xy += one * t * *v;
        ++count;
      }
      const double determinant = w * xx - x * x;
      if (count < 3 || !(determinant > 0)) continue;
      levels.emplace_back((xx * y - x * xy) / determinant, xx / determinant);
      sum += levels.back().first / levels.back().second;
      weight += 1 / levels.back().second;
    }
  }
  if (levels.empty()) return {};
  const double mean = sum / weight;
  for (const auto& [level, variance] : levels) {
    chi_square += (level - mean) * (level - mean) / variance;
    ++freedom;
  }
  const double inflation = freedom > 0 ? std::max(chi_square / freedom, 1.0) : 1.0;
  return DarkLevel{mean, std::sqrt(inflation / weight)};
}

}  // namespace weft::calibration
