// SPDX-License-Identifier: Apache-2.0
#include "material/opacity/fill.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "core/base/parallel.h"
#include "core/solve/solve_record.h"

namespace weft::material {
namespace {

constexpr int kMostReach_px = 64;

constexpr std::size_t kSlopes = 2;    // planes that are level where no cloth is near
constexpr std::size_t kAveraged = 5;  // planes of slope and albedo, which have means

/// Planes of slope, albedo and lobe, as one list.
std::vector<View<float>> filled_planes(Surface& surface) {
  std::vector<View<float>> planes;
  for (Image<float>* map : {&surface.slope, &surface.albedo, &surface.lobe}) {
    for (int p = 0; p < map->planes(); ++p) planes.push_back(map->plane(p));
  }
  return planes;
}

Image<std::uint8_t> cloth_of(const Surface& surface, double least_opacity) {
  Image<std::uint8_t> cloth(surface.size());
  for (int y = 0; y < cloth.height(); ++y) {
    for (int x = 0; x < cloth.width(); ++x) {
      const bool solved = (surface.status(x, y) & kNoSolution) == 0;
      cloth(x, y) = solved && (surface.opacity.empty() || double{surface.opacity(x, y)} >= least_opacity);
    }
  }
  return cloth;
}

std::vector<double> means_of(const std::vector<View<float>>& planes, const Image<std::uint8_t>& cloth) {
  std::vector<double> sums(planes.size(), 0.0);
  double count = 0;
  for (int y = 0; y < cloth.height(); ++y) {
    for (int x = 0; x < cloth.width(); ++x) {
      if (cloth(x, y) == 0) continue;
      count += 1;
      for (std::size_t p = 0; p < planes.size(); ++p) sums[p] += double{planes[p](x, y)};
    }
  }
  for (double& sum : sums) sum = count > 0 ? sum / count : 0;
  std::fill_n(sums.begin(), kSlopes, 0.0);
  if (sums.size() > kAveraged) {
    double* lobe = &sums[kAveraged];
    lobe[0] = lobe[1] = (lobe[0] + lobe[1]) / 2;
    lobe[2] = 0;
  }
  return sums;
}

/// Fills pixels of a row from cloth, which no thread changes.
class RowFiller {
 public:
  RowFiller(const std::vector<View<float>>& planes, const Image<std::uint8_t>& cloth, bool is_tile,
            int reach_px)
      : planes_(planes), cloth_(cloth), is_tile_(is_tile), reach_px_(reach_px) {}

  /// Whether cloth is in reach; then (x, y) has its values.
  bool fill(int x, int y) {
    std::ranges::fill(sums_, 0.0);
    double weight = 0;
    int nearest2 = std::numeric_limits<int>::max();
    for (int dy = -reach_px_; dy <= reach_px_; ++dy) {
      for (int dx = -reach_px_; dx <= reach_px_; ++dx) {
        const int away2 = dx * dx + dy * dy;
        if (away2 > reach_px_ * reach_px_) continue;
        const int i = place(x + dx, cloth_.width()), j = place(y + dy, cloth_.height());
        if (i < 0 || j < 0 || cloth_(i, j) == 0) continue;
        weight += 1.0 / away2;
        for (std::size_t p = 0; p < kAveraged; ++p) sums_[p] += double{planes_[p](i, j)} / away2;
        if (away2 >= nearest2) continue;
        nearest2 = away2;
        for (std::size_t p = kAveraged; p < planes_.size(); ++p) planes_[p](x, y) = planes_[p](i, j);
      }
    }
    if (!(weight > 0)) return false;
    for (std::size_t p = 0; p < kAveraged; ++p) planes_[p](x, y) = static_cast<float>(sums_[p] / weight);
    return true;
  }

 private:
  // -1: beyond the border.
  int place(int i, int size) const {
    if (is_tile_) return (i % size + size) % size;
    return i < size ? i : -1;
  }

  const std::vector<View<float>>& planes_;
  const Image<std::uint8_t>& cloth_;
  bool is_tile_;
  int reach_px_;
  std::array<double, kAveraged> sums_{};
};

}  // namespace

FillFacts fill_holes(Surface& surface, const FillOptions& options) {
  const int reach_px = std::clamp(options.reach_px, 0, kMostReach_px);
  const std::vector<View<float>> planes = filled_planes(surface);
  const Image<std::uint8_t> cloth = cloth_of(surface, options.least_opacity);
  const std::vector<double> means = means_of(planes, cloth);
  std::vector<FillFacts> rows(static_cast<std::size_t>(surface.size().height));
  parallel_for(rows.size(), options.threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    RowFiller filler(planes, cloth, surface.is_tile, reach_px);
    for (int x = 0; x < surface.size().width; ++x) {
      if (cloth(x, y) != 0) continue;
      if (filler.fill(x, y)) {
        ++rows[row].filled;
        continue;
      }
      ++rows[row].levelled;
      for (std::size_t p = 0; p < planes.size(); ++p) planes[p](x, y) = static_cast<float>(means[p]);
    }
  });
  FillFacts all;
  for (const FillFacts& row : rows) {
    all.filled += row.filled;
    all.levelled += row.levelled;
  }
  return all;
}

}  // namespace weft::material
