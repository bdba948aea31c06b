// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/seed_iteration.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace weft::calibration {
namespace {

// Intensities of one LED's cells, each the mean of its neighbours by a Gaussian; cells of nothing stay out of
// it.
void filter(std::vector<std::array<double, 3>>& intensity, const CellGrid& grid, double sigma) {
  if (!(sigma > 0)) return;
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  const auto along = [&](int count, int other, auto index) {
    std::vector<std::array<double, 3>> line(static_cast<std::size_t>(count));
    for (int j = 0; j < other; ++j) {
      for (int i = 0; i < count; ++i) {
        double weights = 0;
        std::array<double, 3> sum = {};
        for (int k = std::max(i - reach, 0); k <= std::min(i + reach, count - 1); ++k) {
          const std::array<double, 3>& from = intensity[index(k, j)];
          if (!(from[0] > 0)) continue;
          const double weight = std::exp(-(k - i) * (k - i) / (2 * sigma * sigma));
          weights += weight;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * from[c];
        }
        for (double& s : sum) s = weights > 0 ? s / weights : 0;
        line[static_cast<std::size_t>(i)] = sum;
      }
      for (int i = 0; i < count; ++i) {
        if (intensity[index(i, j)][0] > 0) intensity[index(i, j)] = line[static_cast<std::size_t>(i)];
      }
    }
  };
  const auto columns = static_cast<std::size_t>(grid.columns);
  along(grid.columns, grid.rows,
        [=](int x, int y) { return static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x); });
  along(grid.rows, grid.columns,
        [=](int y, int x) { return static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x); });
}

class Iteration {
 public:
  Iteration(const PaperScene& start, std::span<const PaperReading> readings, const CellGrid& grid,
            const SeedOptions& options)
      : start_(start), grid_(grid), options_(options), readings_(start.lights.leds.size()) {
    for (auto& of_led : readings_) of_led.resize(grid.cells());
    for (const PaperReading& r : readings) {
      if (r.sheet == 0) readings_[r.led][grid.cell_of(r.x_px, r.y_px)] = r.reading_rgb;
    }
  }

  Result<SeedLights> run() {
    SeedLights lights;
    lights.grid = grid_;
    begin(lights.maps);
    for (int step = 0; step <= options_.iterations; ++step) {
      SeedStep& did = lights.steps.emplace_back();
      if (step > 0) did.direction_change_deg = update_directions(lights.maps);
      did.intensity_change = update_intensities(lights.maps);
      const std::optional<double> residual = paper_residual_deg(lights.maps);
      if (!residual) {
        return Error{ErrorKind::kBadData, "the seed's iteration cannot run", "sheet 1",
                     "nowhere do three LEDs light it", "photograph a flat sheet that fills the frame"};
      }
      did.paper_residual_deg = *residual;
    }
    return lights;
  }

 private:
  void begin(std::vector<LightMap>& maps) const;
  double update_directions(std::vector<LightMap>& maps) const;
  double update_intensities(std::vector<LightMap>& maps) const;
  std::optional<double> paper_residual_deg(const std::vector<LightMap>& maps) const;

  const PaperScene& start_;
  const CellGrid& grid_;
  const SeedOptions& options_;
  std::vector<std::vector<std::array<double, 3>>> readings_;  // [led][cell]; 0 where there is none
};

void Iteration::begin(std::vector<LightMap>& maps) const {
  maps.resize(readings_.size());
  for (std::size_t k = 0; k < maps.size(); ++k) {
    maps[k].intensity_rgb.resize(grid_.cells());
    for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
      const auto [x, y] = grid_.centre_px(cell);
      maps[k].direction.push_back(
          normalized(start_.lights.leds[k].position_mm - point_on_plane(start_.camera, x, y, 0)));
    }
  }
}

// l_z = I / i, by the mean of the channels; the azimuth stays.
double Iteration::update_directions(std::vector<LightMap>& maps) const {
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
      const std::array<double, 3>&reading = readings_[k][cell], &intensity = maps[k].intensity_rgb[cell];
      if (!(intensity[0] > 0)) continue;
      double z = 0;
      for (std::size_t c = 0; c < 3; ++c)
        z += reading[c] / start_.paper.reflectance_rgb[c] / intensity[c] / 3;
      z = std::min(z, 1.0);
      Vec3& l = maps[k].direction[cell];
      const double before = std::hypot(l.x, l.y), after = std::sqrt(1 - z * z);
      const double scale = before > 0 ? after / before : 0;
      const Vec3 updated = {l.x * scale, l.y * scale, z};
      sum += angle_deg(l, updated);
      ++count;
      l = updated;
    }
  }
  return count > 0 ? sum / count : 0;
}

double Iteration::update_intensities(std::vector<LightMap>& maps) const {
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    std::vector<std::array<double, 3>> next(grid_.cells());
    for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
      const double z = maps[k].direction[cell].z;
      if (!(z > 0) || !(readings_[k][cell][0] > 0)) continue;
      for (std::size_t c = 0; c < 3; ++c)
        next[cell][c] = readings_[k][cell][c] / start_.paper.reflectance_rgb[c] / z;
    }
    filter(next, grid_, options_.filter_cells);
    for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
      if (!(maps[k].intensity_rgb[cell][0] > 0 && next[cell][0] > 0)) continue;
      const double change = next[cell][1] / maps[k].intensity_rgb[cell][1] - 1;
      sum += change * change;
      ++count;
    }
    maps[k].intensity_rgb = std::move(next);
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

std::optional<double> Iteration::paper_residual_deg(const std::vector<LightMap>& maps) const {
  double sum = 0, count = 0;
  for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    int lit = 0;
    for (std::size_t k = 0; k < maps.size(); ++k) {
      const double intensity = maps[k].intensity_rgb[cell][1];
      if (!(intensity > 0)) continue;
      ++lit;
      const Vec3 l = maps[k].direction[cell];
      const Eigen::Vector3d row(l.x, l.y, l.z);
      normal += row * row.transpose();
      right += readings_[k][cell][1] / start_.paper.reflectance_rgb[1] / intensity * row;
    }
    if (lit < 3) continue;
    const Eigen::Vector3d n = normal.ldlt().solve(right);
    const double angle = angle_deg({n[0], n[1], n[2]}, {0, 0, 1});
    if (!std::isfinite(angle)) continue;
    sum += angle * angle;
    ++count;
  }
  if (count == 0) return {};
  return std::sqrt(sum / count);
}

}  // namespace

Result<SeedLights> iterate_seed(const PaperScene& start, std::span<const PaperReading> readings,
                                const CellGrid& grid, const SeedOptions& options) {
  return Iteration(start, readings, grid, options).run();
}

NearLights lights_of(const SeedLights& seed, const PaperScene& start) {
  NearLights lights;
  for (std::size_t k = 0; k < seed.maps.size(); ++k) {
    // Three constants, a channel each, and five terms that they share.
    using Normal = Eigen::Matrix<double, 8, 8>;
    using Column = Eigen::Matrix<double, 8, 1>;
    Normal normal = 1e-9 * Normal::Identity();
    Column right = Column::Zero();
    for (std::size_t cell = 0; cell < seed.grid.cells(); ++cell) {
      const auto [x, y] = seed.grid.centre_px(cell);
      const auto [u, v] = frame_place(seed.grid.frame, x, y);
      const double d = length(start.lights.leds[k].position_mm - point_on_plane(start.camera, x, y, 0));
      for (int c = 0; c < 3; ++c) {
        const double intensity = seed.maps[k].intensity_rgb[cell][static_cast<std::size_t>(c)];
        if (!(intensity > 0)) continue;
        Column row;
        row << 0, 0, 0, u, v, u * u, u * v, v * v;
        row[c] = 1;
        normal += row * row.transpose();
        right += std::log(intensity * d * d) * row;
      }
    }
    const Column fit = normal.ldlt().solve(right);
    NearLight led = start.lights.leds[k];
    led.mu = 0;
    for (int c = 0; c < 3; ++c) led.flux_rgb[static_cast<std::size_t>(c)] = std::exp(fit[c]);
    for (int i = 0; i < 5; ++i) led.log_gain_quadratic[static_cast<std::size_t>(i + 1)] = fit[3 + i];
    lights.leds.push_back(led);
  }
  return lights;
}

}  // namespace weft::calibration
