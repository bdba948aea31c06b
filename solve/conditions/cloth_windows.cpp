// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/cloth_windows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"
#include "solve/photographs/picture_axes.h"
#include "solve/photographs/tile_reader.h"
#include "solver/method.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::solve {
namespace {

constexpr int kSide = 160;                                 // of a window, cells
constexpr int kLargestCell = 8;                            // pixels
constexpr double kMostBent = 8e-4;                         // 1 - |mean normal| of a cell: 2.3 degrees rms
constexpr double kMostHoles = 0.02, kMostSpecular = 0.15;  // shares
constexpr double kMostMisfit =
    0.006;  // of the albedo, beside noise: of photographs 0.004 at most on matt cloth
constexpr double kLeastAlbedo = 1e-4;

int cells_at_most(Size size, int cell_px) {
  return std::min({kSide, size.width / cell_px, size.height / cell_px});
}

// The tile of this many cells around a place in the frame, in shares of what it may move.
Rect tile_at(Size size, int side_px, double x, double y) {
  const int x0 = static_cast<int>(x * (size.width - side_px)) / kRowGroup * kRowGroup;
  const int y0 = static_cast<int>(y * (size.height - side_px)) / 2 * 2;
  return {x0, y0, x0 + side_px, y0 + side_px};
}

// A tile by Lambert's law.
struct Solved {
  Rect tile;
  Image<float> normal, albedo, residual;
  Image<std::uint16_t> status;
};

Solved solved(const Photographs& photographs, Rect tile) {
  const Size size = {tile.width(), tile.height()};
  Solved maps = {tile, Image<float>(size, 3), Image<float>(size, 3), Image<float>(size),
                 Image<std::uint16_t>(size)};
  Image<float> sigma(size), sigma_albedo(size, 3);
  const auto planes = [](Image<float>& image) {
    return std::array{image.plane(0), image.plane(1), image.plane(2)};
  };
  TileReader reader(photographs, {.width = tile.width(), .height = tile.height()});
  solver::standard_method()->solve(
      reader.read(tile), {planes(maps.normal), planes(maps.albedo), sigma.plane(), planes(sigma_albedo),
                          maps.residual.plane(), maps.status.plane()});
  return maps;
}

// What a pixel says of brightness: its albedo over the mean one of its colour, by the colours that it has.
class Brightness {
 public:
  Brightness(const Solved& maps, const Planes& planes) : maps_(maps), planes_(planes) {
    std::array<double, 3> counts = {};
    for_each([&](int, int, std::size_t c, double albedo) {
      mean_[c] += albedo;
      ++counts[c];
    });
    for (std::size_t c = 0; c < 3; ++c)
      mean_[c] = std::max(mean_[c] / std::max(counts[c], 1.0), kLeastAlbedo);
  }
  double of_cell(int u, int v, int cell_px) const {
    double sum = 0, count = 0;
    for (int y = v * cell_px; y < (v + 1) * cell_px; ++y) {
      for (int x = u * cell_px; x < (u + 1) * cell_px; ++x) {
        add(x, y, [&](int, int, std::size_t c, double albedo) {
          sum += albedo / mean_[c];
          ++count;
        });
      }
    }
    return count > 0 ? sum / count : 0;
  }

 private:
  template <typename Take>
  void add(int x, int y, const Take& take) const {
    if (maps_.status(x, y) & kNoSolution) return;
    for (int p = 0; p < planes_.count; ++p) {
      const int c = planes_.channel_at(p, maps_.tile.x0 + x, maps_.tile.y0 + y);
      take(x, y, static_cast<std::size_t>(c), static_cast<double>(maps_.albedo(x, y, p)));
    }
  }
  template <typename Take>
  void for_each(const Take& take) const {
    for (int y = 0; y < maps_.status.height(); ++y) {
      for (int x = 0; x < maps_.status.width(); ++x) add(x, y, take);
    }
  }

  const Solved& maps_;
  Planes planes_;
  std::array<double, 3> mean_ = {};
};

Vec3 mean_normal(const Solved& maps, int x0, int y0, int cell_px, int& pixels) {
  Vec3 sum;
  pixels = 0;
  for (int y = y0; y < y0 + cell_px; ++y) {
    for (int x = x0; x < x0 + cell_px; ++x) {
      if (maps.status(x, y) & kNoSolution) continue;
      sum = sum + Vec3{maps.normal(x, y, 0), maps.normal(x, y, 1), maps.normal(x, y, 2)};
      ++pixels;
    }
  }
  return pixels > 0 ? (1.0 / pixels) * sum : sum;
}

double bent_within(const Solved& maps, int cell_px) {
  double bent = 0, cells = 0;
  for (int y = 0; y + cell_px <= maps.status.height(); y += cell_px) {
    for (int x = 0; x + cell_px <= maps.status.width(); x += cell_px) {
      int pixels = 0;
      const Vec3 mean = mean_normal(maps, x, y, cell_px, pixels);
      if (pixels == 0) continue;
      bent += 1 - length(mean);
      ++cells;
    }
  }
  return cells > 0 ? bent / cells : 1;
}

// The largest that yarns in the middle of the frame allow.
int cell_of(const Photographs& photographs) {
  int largest = 1;
  while (2 * largest <= kLargestCell && cells_at_most(photographs.size, 2 * largest) >= kSide) largest *= 2;
  if (largest == 1) return 1;
  const int side = kSide * largest;
  const Solved probe = solved(photographs, tile_at(photographs.size, side, 0.5, 0.5));
  int cell = 1;
  while (2 * cell <= largest && bent_within(probe, 2 * cell) < kMostBent) cell *= 2;
  return cell;
}

// The mean square over the albedo that noise leaves of a misfit; none is known of developed photographs.
double noise2_of(const Photographs& photographs, const Solved& maps) {
  constexpr int kGreen = 1;
  const std::optional<NoiseModel> noise = photographs.noise();
  if (!noise) return 0;
  const int x = (maps.tile.x0 + maps.tile.x1) / 2, y = (maps.tile.y0 + maps.tile.y1) / 2;
  const solver::ResidualNoise left = solver::residual_noise(*photographs.field, *noise, x, y, kGreen);
  std::vector<float> albedos;
  for (int row = 0; row < maps.albedo.height(); ++row)
    albedos.insert(albedos.end(), maps.albedo.plane().row(row),
                   maps.albedo.plane().row(row) + maps.albedo.width());
  const double albedo = std::max(static_cast<double>(median(std::move(albedos))), kLeastAlbedo);
  return (static_cast<double>(left.photons[2]) + static_cast<double>(left.floor) / albedo) / albedo;
}

bool fits_lambert(const Photographs& photographs, const Solved& maps) {
  std::vector<float> misfits;
  double specular = 0, unsolved = 0;
  for (int y = 0; y < maps.status.height(); ++y) {
    for (int x = 0; x < maps.status.width(); ++x) {
      specular += (maps.status(x, y) & kSpecular) != 0;
      if (maps.status(x, y) & kNoSolution) {
        ++unsolved;
      } else {
        misfits.push_back(maps.residual(x, y));
      }
    }
  }
  const auto pixels = static_cast<double>(maps.status.size().pixels());
  return unsolved < kMostHoles * pixels && specular < kMostSpecular * pixels && !misfits.empty() &&
         std::pow(static_cast<double>(median(std::move(misfits))), 2) <
             noise2_of(photographs, maps) + kMostMisfit * kMostMisfit;
}

// A cell without a solution goes on as the one before.
std::optional<solver::LambertWindow> window_of(const Photographs& photographs, const Solved& maps,
                                               int cell_px, int cells) {
  if (!fits_lambert(photographs, maps)) return {};
  const Mat3 axes = picture_from_rig(photographs.camera);
  const Brightness brightness(maps, photographs.planes());
  const int step = photographs.planes().count == 1 && cell_px == 1 ? 2 : 1;
  solver::LambertWindow window = {Image<float>({cells, cells}, 3), Image<float>({cells, cells}), step};
  Vec3 normal = {0, 0, 1};
  double albedo = 1;
  for (int v = 0; v < cells; ++v) {
    for (int u = 0; u < cells; ++u) {
      int pixels = 0;
      const Vec3 mean = mean_normal(maps, u * cell_px, v * cell_px, cell_px, pixels);
      if (length(mean) > 0) normal = axes * normalized(mean);
      if (const double here = brightness.of_cell(u, v, cell_px); here > kLeastAlbedo) albedo = here;
      window.normal(u, v, 0) = static_cast<float>(normal.x);
      window.normal(u, v, 1) = static_cast<float>(normal.y);
      window.normal(u, v, 2) = static_cast<float>(normal.z);
      window.albedo(u, v) = static_cast<float>(albedo);
    }
  }
  return window;
}

}  // namespace

ClothWindows cloth_windows(const Photographs& photographs, int threads) {
  ClothWindows cloth = {cell_of(photographs), {}};
  const int cells = cells_at_most(photographs.size, cloth.cell_px);
  if (cells < solver::kLeastToldSide) return cloth;
  const int side = cells * cloth.cell_px;
  const bool has_four = photographs.size.width >= 2 * side && photographs.size.height >= 2 * side;
  std::vector<Rect> tiles;
  if (has_four) {
    for (const double y : {0.25, 0.75}) {
      for (const double x : {0.25, 0.75}) tiles.push_back(tile_at(photographs.size, side, x, y));
    }
  } else {
    tiles.push_back(tile_at(photographs.size, side, 0.5, 0.5));
  }
  std::vector<std::optional<solver::LambertWindow>> windows(tiles.size());
  parallel_for(tiles.size(), threads, [&](std::size_t i, int) {
    windows[i] = window_of(photographs, solved(photographs, tiles[i]), cloth.cell_px, cells);
  });
  for (auto& window : windows) {
    if (window) cloth.windows.push_back(std::move(*window));
  }
  return cloth;
}

}  // namespace weft::solve
