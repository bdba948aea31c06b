// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "calibration/camera/markers.h"
#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr double kBrightShare = 0.995;  // of the pixels are darker than kBright
constexpr float kBright = 240;

// What brings the 99.5th percentile of the values to kBright.
float scale_of(std::vector<float> values) {
  const float bright = lower_quantile(std::move(values), kBrightShare);
  return bright > 0 ? kBright / bright : 1;
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F) + 0.5F);
}

// Light above black of one photosite, as its channel weighs.
struct SiteLight {
  const RawFrame& frame;
  std::array<std::array<float, 2>, 2> gain = {{{1, 1}, {1, 1}}};

  float operator()(int x, int y) const {
    const auto j = static_cast<std::size_t>(y & 1), i = static_cast<std::size_t>(x & 1);
    return std::max(0.0F, static_cast<float>(frame.counts(x, y)) - frame.black[j][i]) * gain[j][i];
  }
};

// Gains that make the means of the four sites alike: a grey picture on the whole.
SiteLight balanced(const RawFrame& frame) {
  SiteLight light = {frame};
  std::array<std::array<double, 2>, 2> sum = {};
  const int width = frame.counts.width() & ~1, height = frame.counts.height() & ~1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      sum[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)] +=
          static_cast<double>(light(x, y));
  }
  const double most = std::max({sum[0][0], sum[0][1], sum[1][0], sum[1][1]});
  for (std::size_t j = 0; j < 2; ++j) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (sum[j][i] > 0) light.gain[j][i] = static_cast<float>(most / sum[j][i]);
    }
  }
  return light;
}

// The neighbour beyond the border that has the same filter.
int mirrored(int i, int n) {
  if (i < 0) return std::min(-i, n - 1);
  return i < n ? i : std::max(0, 2 * n - 2 - i);
}

}  // namespace

Image<std::uint8_t> grey_picture(const RawFrame& frame) {
  const int width = frame.counts.width(), height = frame.counts.height();
  const SiteLight light = balanced(frame);
  std::vector<float> cells;
  for (int y = 0; y + 1 < height; y += 8) {
    for (int x = 0; x + 1 < width; x += 8)
      cells.push_back((light(x, y) + light(x + 1, y) + light(x, y + 1) + light(x + 1, y + 1)) / 4);
  }
  const float scale = scale_of(std::move(cells));

  Image<std::uint8_t> grey(frame.counts.size());
  std::vector<float> column(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    const int above = mirrored(y - 1, height), below = mirrored(y + 1, height);
    for (int x = 0; x < width; ++x)
      column[static_cast<std::size_t>(x)] = light(x, above) + 2 * light(x, y) + light(x, below);
    const auto at = [&](int x) { return column[static_cast<std::size_t>(mirrored(x, width))]; };
    for (int x = 0; x < width; ++x) grey(x, y) = to_byte(scale / 16 * (at(x - 1) + 2 * at(x) + at(x + 1)));
  }
  return grey;
}

Image<std::uint8_t> grey_picture(std::span<const View<const float>> rgb) {
  const Size size = rgb[0].size();
  const auto light = [&](int x, int y) {
    const float value = (rgb[0](x, y) + 2 * rgb[1](x, y) + rgb[2](x, y)) / 4;
    return std::isfinite(value) ? std::max(0.0F, value) : 0.0F;
  };
  std::vector<float> samples;
  for (int y = 0; y < size.height; y += 4) {
    for (int x = 0; x < size.width; x += 4) samples.push_back(light(x, y));
  }
  const float scale = scale_of(std::move(samples));
  Image<std::uint8_t> grey(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) grey(x, y) = to_byte(scale * light(x, y));
  }
  return grey;
}

}  // namespace weft::calibration
