// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/saturation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace weft::simulator {
namespace {

constexpr double kLowest = -0.25, kHighest = 1, kLeastSlope = 0.1;
constexpr int kMostSteps = 100;
constexpr double kLastStep = 1e-9;     // its square is what is left
constexpr double kLeastWeight = 1e-3;  // of the first

}  // namespace

Result<NonLinearity> NonLinearity::of(std::array<double, 2> a_and_b) {
  const NonLinearity curve(a_and_b);
  // The slope is a parabola: least at an end or at its vertex.
  const double vertex = curve.b_ != 0 ? std::clamp(-curve.a_ / (3 * curve.b_), kLowest, kHighest) : kHighest;
  for (const double v : {kLowest, vertex, kHighest})
    if (!(curve.slope(v) >= kLeastSlope))
      return Error{ErrorKind::kBadData, "the sensor's counts do not rise with light", "camera",
                   fmt::format("v (1 + {} v + {} v^2) has slope {:.3g} at v = {:.3g}", curve.a_, curve.b_,
                               curve.slope(v), v),
                   "use smaller coefficients of non-linearity"};
  return curve;
}

double NonLinearity::distorted(double signal) const {
  if (a_ == 0 && b_ == 0) return signal;
  if (signal <= linear(kLowest)) return kLowest + (signal - linear(kLowest)) / slope(kLowest);
  if (!(signal < linear(kHighest))) return kHighest + (signal - linear(kHighest)) / slope(kHighest);
  double low = kLowest, high = kHighest, v = std::clamp(signal, low, high);
  for (int i = 0; i < kMostSteps; ++i) {
    const double error = linear(v) - signal;
    (error > 0 ? high : low) = v;
    const double step = error / slope(v);
    const bool is_inside = v - step >= low && v - step <= high;
    v = is_inside ? v - step : (low + high) / 2;
    if (is_inside && std::abs(step) < kLastStep) break;
  }
  return v;
}

BloomKernel bloom_kernel(const BloomSettings& settings) {
  BloomKernel kernel;
  if (settings.share <= 0) return kernel;
  for (double weight = 1; weight >= kLeastWeight; weight *= settings.decay) kernel.weights.push_back(weight);
  const double sum = 2 * std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0);
  for (double& weight : kernel.weights) weight *= settings.share / sum;
  return kernel;
}

void bloom(const BloomKernel& kernel, double full, std::span<const double> in, Rect out_rect,
           std::span<double> out) {
  const auto width = static_cast<std::size_t>(out_rect.width());
  const std::size_t radius = kernel.weights.size();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double* here = in.data() + i + radius * width;
    double sample = std::min(*here, full);
    for (std::size_t k = 1; k <= radius; ++k)
      sample += kernel.weights[k - 1] * (std::max(here[-static_cast<std::ptrdiff_t>(k * width)] - full, 0.0) +
                                         std::max(here[k * width] - full, 0.0));
    out[i] = sample;
  }
}

}  // namespace weft::simulator
