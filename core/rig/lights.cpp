// SPDX-License-Identifier: Apache-2.0
#include "core/rig/lights.h"

#include <fmt/format.h>

#include <algorithm>

namespace weft {
namespace {

// The four uniform cubic B-spline weights at fraction t of a knot interval.
std::array<double, 4> cubic_weights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (4 - 6 * t * t + 3 * t * t * t) / 6, (4 - 6 * s * s + 3 * s * s * s) / 6,
          t * t * t / 6};
}

struct Knot {
  int first;
  std::array<double, 4> weights;
};

// The knot interval that holds w in [-1, 1] where `count` coefficients span the frame.
Knot knot_of(double w, int count) {
  const int intervals = count - 3;
  const double t = std::clamp((w + 1) / 2, 0.0, 1.0) * intervals;
  const int first = std::min(static_cast<int>(t), intervals - 1);
  return {first, cubic_weights(t - first)};
}

template <typename L>
Result<std::vector<L>> pick(const std::vector<L>& all, const std::vector<int>& numbers) {
  std::vector<L> picked;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const int number = numbers[i];
    if (number < 1 || static_cast<std::size_t>(number) > all.size()) {
      return Error{ErrorKind::kUsage, "no such light", fmt::format("light {}", number),
                   fmt::format("the lights are numbered from 1 to {}", all.size()),
                   "name lights that are there"};
    }
    if (std::count(numbers.begin(), numbers.end(), number) > 1) {
      return Error{ErrorKind::kUsage, "a light is named twice", fmt::format("light {}", number), "",
                   "name every light once"};
    }
    picked.push_back(all[static_cast<std::size_t>(number) - 1]);
  }
  return picked;
}

}  // namespace

double GainSpline::at(double u, double v) const {
  if (empty()) return 0;
  const Knot across = knot_of(u, columns);
  const Knot down = knot_of(v, rows);
  double sum = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    const std::size_t row = (static_cast<std::size_t>(down.first) + j) * static_cast<std::size_t>(columns);
    for (std::size_t i = 0; i < 4; ++i) {
      sum += down.weights[j] * across.weights[i] *
             coefficients[row + static_cast<std::size_t>(across.first) + i];
    }
  }
  return sum;
}

double NearLights::log_gain(std::size_t led, int channel, double u, double v) const {
  const std::array<double, 6>& q = leds[led].log_gain_quadratic;
  const double own = q[0] + q[1] * u + q[2] * v + q[3] * u * u + q[4] * u * v + q[5] * v * v;
  return log_gain_rgb[static_cast<std::size_t>(channel)].at(u, v) + own;
}

std::optional<std::array<double, 3>> white_gains(const Lights& lights) {
  std::array<double, 3> sum = {};
  const auto add = [&](const std::array<double, 3>& rgb) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += rgb[c];
  };
  if (const auto* near = std::get_if<NearLights>(&lights)) {
    for (const NearLight& led : near->leds) add(led.flux_rgb);
  } else {
    for (const DistantLight& light : std::get<DistantLights>(lights).lights) add(light.irradiance_rgb);
  }
  if (!std::ranges::all_of(sum, [](double light) { return light > 0; })) return std::nullopt;
  return std::array{sum[1] / sum[0], 1.0, sum[1] / sum[2]};
}

std::size_t light_count(const Lights& lights) {
  if (const auto* near = std::get_if<NearLights>(&lights)) return near->leds.size();
  return std::get<DistantLights>(lights).lights.size();
}

Lights brightened(Lights lights, const std::vector<double>& factors) {
  for (std::size_t k = 0; k < factors.size(); ++k) {
    auto* near = std::get_if<NearLights>(&lights);
    std::array<double, 3>& rgb =
        near != nullptr ? near->leds[k].flux_rgb : std::get<DistantLights>(lights).lights[k].irradiance_rgb;
    for (double& value : rgb) value *= factors[k];
  }
  return lights;
}

Result<Lights> select_lights(const Lights& lights, const std::vector<int>& numbers) {
  if (const auto* near = std::get_if<NearLights>(&lights)) {
    Result<std::vector<NearLight>> picked = pick(near->leds, numbers);
    if (!picked) return std::move(picked).error();
    return Lights(NearLights{std::move(*picked), near->log_gain_rgb});
  }
  Result<std::vector<DistantLight>> picked = pick(std::get<DistantLights>(lights).lights, numbers);
  if (!picked) return std::move(picked).error();
  return Lights(DistantLights{std::move(*picked)});
}

}  // namespace weft
