// SPDX-License-Identifier: Apache-2.0
#include "material/maps/gaussian_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/base/parallel.h"

namespace weft::material {
namespace {

constexpr int kCellsASigma = 4, kSigmasOfReach = 4;

int cell_for(Size size, const GaussianGridOptions& options) {
  const int most = std::max(static_cast<int>(std::min(options.sigma_px / kCellsASigma, 1e6)), 1);
  if (!options.is_tile) return std::min(most, std::max({size.width, size.height, 1}));
  const int common = std::gcd(size.width, size.height);  // whole cells, or the tile has a seam
  int cell = std::min(most, common);
  while (common % cell != 0) --cell;
  return cell;
}

/// Sums of values that count, and how many they are; plane 0 and 1.
Image<float> cell_sums(View<const float> map, View<const std::uint8_t> counts, int cell, int threads) {
  Image<float> sums({(map.width() + cell - 1) / cell, (map.height() + cell - 1) / cell}, 2);
  parallel_for(static_cast<std::size_t>(sums.height()), threads, [&](std::size_t cell_y, int) {
    const auto width = static_cast<std::size_t>(sums.width());
    std::vector<double> sum(width), number(width);
    const int y0 = static_cast<int>(cell_y) * cell, y1 = std::min(y0 + cell, map.height());
    for (int y = y0; y < y1; ++y) {
      for (int x = 0; x < map.width(); ++x) {
        if (!std::isfinite(map(x, y)) || (!counts.empty() && counts(x, y) == 0)) continue;
        sum[static_cast<std::size_t>(x / cell)] += static_cast<double>(map(x, y));
        number[static_cast<std::size_t>(x / cell)] += 1;
      }
    }
    for (std::size_t x = 0; x < width; ++x) {
      sums(static_cast<int>(x), static_cast<int>(cell_y), 0) = static_cast<float>(sum[x]);
      sums(static_cast<int>(x), static_cast<int>(cell_y), 1) = static_cast<float>(number[x]);
    }
  });
  return sums;
}

std::vector<float> gaussian(double sigma) {
  const int reach = static_cast<int>(std::ceil(kSigmasOfReach * sigma));
  std::vector<float> taps;
  for (int i = -reach; i <= reach; ++i) {
    taps.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
  }
  return taps;
}

// Along rows into columns: done twice it is the round Gaussian of the map as it lay.
Image<float> blurred_and_transposed(const Image<float>& in, const std::vector<float>& taps, bool is_tile,
                                    int threads) {
  const int reach = static_cast<int>(taps.size() / 2), width = in.width();
  Image<float> out({in.height(), width}, in.planes());
  parallel_for(static_cast<std::size_t>(in.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    std::vector<float> padded(static_cast<std::size_t>(width + 2 * reach));
    for (int p = 0; p < in.planes(); ++p) {
      for (int x = -reach; x < width + reach; ++x) {
        const bool is_inside = x >= 0 && x < width;
        const int at = is_tile ? ((x % width) + width) % width : x;
        padded[static_cast<std::size_t>(x + reach)] = is_inside || is_tile ? in(at, y, p) : 0;
      }
      for (int x = 0; x < width; ++x) {
        const float* from = padded.data() + x;
        float sum = 0;
        for (std::size_t k = 0; k < taps.size(); ++k) sum += taps[k] * from[k];
        out(y, x, p) = sum;
      }
    }
  });
  return out;
}

/// The four coefficients about a place and their shares.
struct Spline {
  int first = 0;
  std::array<float, 4> share = {};
};
Spline spline_at(int pixel, int cell) {
  const double place = (pixel + 0.5) / cell - 0.5, below = std::floor(place), t = place - below, s = 1 - t;
  return {static_cast<int>(below) - 1,
          {static_cast<float>(s * s * s / 6), static_cast<float>((3 * t * t * t - 6 * t * t + 4) / 6),
           static_cast<float>((3 * s * s * s - 6 * s * s + 4) / 6), static_cast<float>(t * t * t / 6)}};
}

}  // namespace

GaussianGrid::GaussianGrid(View<const float> map, View<const std::uint8_t> counts,
                           const GaussianGridOptions& options)
    : size_(map.size()), is_tile_(options.is_tile), cell_(cell_for(map.size(), options)) {
  const double in_cells = options.sigma_px / cell_;
  const double of_cells_and_spline = cell_ > 1 ? 1.0 / 12 + 1.0 / 3 : 0;
  const auto taps = gaussian(std::sqrt(std::max(in_cells * in_cells - of_cells_and_spline, 1e-4)));
  Image<float> sums = cell_sums(map, counts, cell_, options.threads);
  for (int pass = 0; pass < 2; ++pass) {
    sums = blurred_and_transposed(sums, taps, is_tile_, options.threads);
  }
  grid_ = Image<float>(sums.size());
  for (int y = 0; y < grid_.height(); ++y) {
    for (int x = 0; x < grid_.width(); ++x) {
      grid_(x, y) = sums(x, y, 1) > 1e-6f ? sums(x, y, 0) / sums(x, y, 1) : 0;
    }
  }
}

int GaussianGrid::column(int x) const {
  const int count = grid_.width();
  return is_tile_ ? ((x % count) + count) % count : std::clamp(x, 0, count - 1);
}

int GaussianGrid::row(int y) const {
  const int count = grid_.height();
  return is_tile_ ? ((y % count) + count) % count : std::clamp(y, 0, count - 1);
}

void GaussianGrid::read(int y, float* out) const {
  if (cell_ == 1) {
    std::copy_n(grid_.plane().row(y), size_.width, out);
    return;
  }
  std::vector<float> line(static_cast<std::size_t>(grid_.width()) + 4);  // two cells before and two after
  const Spline down = spline_at(y, cell_);
  for (int k = 0; k < 4; ++k) {
    const float* from = grid_.plane().row(row(down.first + k));
    for (std::size_t i = 0; i < line.size(); ++i) {
      line[i] += down.share[static_cast<std::size_t>(k)] * from[column(static_cast<int>(i) - 2)];
    }
  }
  for (int x = 0; x < size_.width; ++x) {
    const Spline across = spline_at(x, cell_);
    const float* from = line.data() + across.first + 2;
    out[x] = across.share[0] * from[0] + across.share[1] * from[1] + across.share[2] * from[2] +
             across.share[3] * from[3];
  }
}

}  // namespace weft::material
