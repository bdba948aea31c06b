// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/lit_dark.h"

#include <algorithm>
#include <cmath>

namespace weft::calibration {
namespace {

constexpr int kParts = 24;  ///< along either side
constexpr double kLike = 0.1;

/// light(x, y) is nothing where there is no green.
template <typename Light>
std::vector<double> parts_of(Size size, const Light& light) {
  std::vector<double> sums(kParts * kParts), counts(kParts * kParts);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::optional<double> value = light(x, y);
      if (!value) continue;
      const auto part =
          static_cast<std::size_t>(static_cast<std::int64_t>(y) * kParts / size.height * kParts +
                                   static_cast<std::int64_t>(x) * kParts / size.width);
      sums[part] += *value;
      ++counts[part];
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(counts[i], 1.0);
  return sums;
}

}  // namespace

std::vector<double> light_by_parts(const RawFrame& frame) {
  return parts_of(frame.counts.size(), [&](int x, int y) -> std::optional<double> {
    if (frame.cfa.channel_at(x, y) != 1) return std::nullopt;
    return frame.counts(x, y) -
           static_cast<double>(frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
  });
}

std::vector<double> light_by_parts(View<const float> green) {
  return parts_of(green.size(), [&](int x, int y) -> std::optional<double> {
    return std::isfinite(green(x, y)) ? std::optional<double>(green(x, y)) : std::nullopt;
  });
}

std::optional<std::size_t> photograph_like(std::span<const double> dark,
                                           std::span<const std::vector<double>> lit) {
  std::optional<std::size_t> like;
  double least = kLike;
  for (std::size_t k = 0; k < lit.size(); ++k) {
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < std::min(dark.size(), lit[k].size()); ++i) {
      mean += lit[k][i] / static_cast<double>(dark.size());
      squares += std::pow(dark[i] - lit[k][i], 2) / static_cast<double>(dark.size());
    }
    if (!(mean > 0) || std::sqrt(squares) / mean >= least) continue;
    least = std::sqrt(squares) / mean;
    like = k;
  }
  return like;
}

}  // namespace weft::calibration
