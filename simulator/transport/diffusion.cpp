// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/diffusion.h"

#include <cmath>

#include "core/base/vec.h"

namespace weft::simulator {
namespace {

constexpr double kCut = 3.5;  // standard deviations
constexpr std::size_t kAtOnce = 8;

struct Node {
  double t, weight;
};
constexpr Node kNodes[] = {{0.585786437626905, 0.853553390593274}, {3.414213562373095, 0.146446609406726}};

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

/// The share of a Gaussian around the middle of a pixel in that pixel and its neighbours along a row.
std::vector<double> profile_of(double sigma_px) {
  if (sigma_px <= 0) return {1};
  const int radius = static_cast<int>(std::ceil(kCut * sigma_px));
  const double scale = std::sqrt(0.5) / sigma_px;
  std::vector<double> profile;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    const double inner = std::abs(i) - 0.5;
    profile.push_back((std::erf((inner + 1) * scale) - std::erf(inner * scale)) / 2);
    sum += profile.back();
  }
  for (double& share : profile) share /= sum;
  return profile;
}

/// out[i] += factor * sum of weights[k] * in[i + k step]: for every i the same products in the same order.
void add_weighted(std::span<const double> weights, const double* in, std::size_t step, double factor,
                  std::span<double> out) {
  const auto add_block = [&](std::size_t i, std::size_t width) {
    std::array<double, kAtOnce> sums = {};
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (std::size_t j = 0; j < width; ++j) sums[j] += weights[k] * in[i + k * step + j];
    for (std::size_t j = 0; j < width; ++j) out[i + j] += factor * sums[j];
  };
  std::size_t i = 0;
  for (; i + kAtOnce <= out.size(); i += kAtOnce) add_block(i, kAtOnce);
  if (i < out.size()) add_block(i, out.size() - i);
}

}  // namespace

Diffusion::Diffusion(double mean_px) {
  double mean_over_l = 0;  // sqrt(pi t) of one Gaussian
  for (const auto& [t, weight] : kNodes) mean_over_l += weight * std::sqrt(kPi * t);
  const double l_px = mean_px / mean_over_l;
  for (const auto& [t, weight] : kNodes) gaussians_.push_back({weight, profile_of(l_px * std::sqrt(2 * t))});
}

void Diffusion::add(std::span<const double> entered, Rect out_rect, std::span<double> left) const {
  const std::size_t width = index(out_rect.width()), height = index(out_rect.height());
  const std::size_t margin = index(radius()), in_width = width + 2 * margin;
  for (const Gaussian& gaussian : gaussians_) {
    const std::size_t reach = gaussian.profile.size() / 2;
    const std::size_t rows = height + 2 * reach;
    std::vector<double> along_rows(rows * width);
    for (std::size_t y = 0; y < rows; ++y) {
      const double* from = entered.data() + (y + margin - reach) * in_width + margin - reach;
      add_weighted(gaussian.profile, from, 1, 1, std::span(along_rows).subspan(y * width, width));
    }
    for (std::size_t y = 0; y < height; ++y) {
      add_weighted(gaussian.profile, along_rows.data() + y * width, width, gaussian.share,
                   left.subspan(y * width, width));
    }
  }
}

}  // namespace weft::simulator
