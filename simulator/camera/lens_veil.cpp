// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/lens_veil.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace weft::simulator {
namespace {

constexpr int kMostCells = 32;  // along a side
constexpr int kLeastSide = 8;   // of a cell, pixels

int cells_along(int pixels, int side) {
  return (pixels + side - 1) / side;
}

/// weights[i][j]: what cell i of a side gets of cell j. Every row has the sum 1.
std::vector<std::vector<double>> spread_along(int pixels, int side, double sigma_px) {
  const int cells = cells_along(pixels, side);
  const auto first = [&](int i) { return std::min(i * side, pixels); };
  const auto middle = [&](int i) { return (first(i) + first(i + 1)) / 2.0; };
  std::vector<std::vector<double>> weights;
  for (int i = 0; i < cells; ++i) {
    std::vector<double>& row = weights.emplace_back();
    double sum = 0;
    for (int j = 0; j < cells; ++j) {
      const double t = (middle(i) - middle(j)) / sigma_px;
      row.push_back((first(j + 1) - first(j)) * std::exp(-t * t / 2));
      sum += row.back();
    }
    for (double& weight : row) weight /= sum;
  }
  return weights;
}

/// The two cells that a place lies between, and how far it is from the first towards the second.
struct Mix {
  int first, second;
  double share;
};
Mix mix_at(double at, int side, int cells) {
  const double cell = std::clamp((at + 0.5) / side - 0.5, 0.0, cells - 1.0);
  const int first = static_cast<int>(cell);
  return {first, std::min(first + 1, cells - 1), cell - first};
}

void add(Rgb& sum, double weight, const Rgb& light) {
  for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * light[c];
}

}  // namespace

FrameLight::FrameLight(Size frame)
    : frame_(frame),
      side_(std::max(cells_along(std::max(frame.width, frame.height), kMostCells), kLeastSide)),
      means_({cells_along(frame.width, side_), cells_along(frame.height, side_)}, 1) {}

Rect FrameLight::cell(int column, int row) const {
  return {column * side_, row * side_, std::min((column + 1) * side_, frame_.width),
          std::min((row + 1) * side_, frame_.height)};
}

Rgb FrameLight::at(double x, double y) const {
  const Mix across = mix_at(x, side_, columns()), down = mix_at(y, side_, rows());
  Rgb light = {};
  add(light, (1 - down.share) * (1 - across.share), mean(across.first, down.first));
  add(light, (1 - down.share) * across.share, mean(across.second, down.first));
  add(light, down.share * (1 - across.share), mean(across.first, down.second));
  add(light, down.share * across.share, mean(across.second, down.second));
  return light;
}

FrameLight veil_of(const VeilSettings& settings, const FrameLight& light) {
  const Rect first = light.cell(0, 0), last = light.cell(light.columns() - 1, light.rows() - 1);
  const double sigma_px = settings.spread * std::hypot(last.x1, last.y1);
  const auto across = spread_along(last.x1, first.x1, sigma_px);
  const auto down = spread_along(last.y1, first.x1, sigma_px);
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  FrameLight along_rows({last.x1, last.y1}), veil({last.x1, last.y1});
  for (int y = 0; y < light.rows(); ++y)
    for (int x = 0; x < light.columns(); ++x)
      for (int j = 0; j < light.columns(); ++j)
        add(along_rows.mean(x, y), across[index(x)][index(j)], light.mean(j, y));
  for (int y = 0; y < light.rows(); ++y)
    for (int x = 0; x < light.columns(); ++x)
      for (int j = 0; j < light.rows(); ++j)
        add(veil.mean(x, y), settings.share * down[index(y)][index(j)], along_rows.mean(x, j));
  return veil;
}

}  // namespace weft::simulator
