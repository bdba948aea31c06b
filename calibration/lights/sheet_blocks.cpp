// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/sheet_blocks.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::calibration {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// One photosite about the centre of its block.
struct Site {
  double x, y, reading;
};

// reading = level + slope_x x + slope_y y
struct Plane {
  double level = 0, slope_x = 0, slope_y = 0;
  double at(const Site& s) const { return level + slope_x * s.x + slope_y * s.y; }
};

// Least squares through at least three sites that do not lie in a line; else their mean.
Plane plane_through(std::span<const Site> sites) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Site& s : sites) {
    const Eigen::Vector3d row(1, s.x, s.y);
    normal += row * row.transpose();
    right += s.reading * row;
  }
  const double n = normal(0, 0);
  const double spread_x = normal(1, 1) - normal(0, 1) * normal(0, 1) / n;
  const double spread_y = normal(2, 2) - normal(0, 2) * normal(0, 2) / n;
  const double cross = normal(1, 2) - normal(0, 1) * normal(0, 2) / n;
  if (!(spread_x * spread_y - cross * cross > 1e-9 * n * n)) return {right[0] / n, 0, 0};
  const Eigen::Vector3d p = normal.ldlt().solve(right);
  return {p[0], p[1], p[2]};
}

double scatter_about(const Plane& plane, std::span<const Site> sites) {
  double sum = 0;
  for (const Site& s : sites) sum += (s.reading - plane.at(s)) * (s.reading - plane.at(s));
  const auto freedom = static_cast<double>(sites.size()) - 3;
  return freedom > 0 ? std::sqrt(sum / freedom) : 0;
}

// `sites` loses those that are left out.
BlockMean mean_of(std::vector<Site>& sites, int missing, int full) {
  BlockMean block;
  block.full = static_cast<std::uint16_t>(full);
  block.reading = kNaN;
  if (full > 0 || sites.size() < 4 || static_cast<std::size_t>(missing) > sites.size()) return block;
  const std::size_t before = sites.size();
  Plane plane = plane_through(sites);
  double scatter = scatter_about(plane, sites);
  // What is left out first hides what is nearer: the scatter shrinks as it goes.
  for (int round = 0; round < 3; ++round) {
    const auto end = std::remove_if(sites.begin(), sites.end(), [&](const Site& s) {
      return std::abs(s.reading - plane.at(s)) > kClipFrom_sigmas * scatter;
    });
    if (end == sites.end() || end - sites.begin() < 4) break;
    sites.erase(end, sites.end());
    plane = plane_through(sites);
    scatter = scatter_about(plane, sites);
  }
  block.reading = plane.level;
  block.standard_error = static_cast<float>(scatter / std::sqrt(static_cast<double>(sites.size())));
  block.count = static_cast<std::uint16_t>(sites.size());
  block.clipped = static_cast<std::uint16_t>(before - sites.size());
  return block;
}

// What the sites of one channel of one block say as they come.
struct Gathered {
  std::vector<Site> sites;
  int missing = 0, full = 0;

  void add(double x, double y, float reading) {
    if (std::isfinite(reading)) {
      sites.push_back({x, y, static_cast<double>(reading)});
    } else {
      ++(std::isnan(reading) ? missing : full);
    }
  }
  BlockMean take() {
    const BlockMean mean = mean_of(sites, missing, full);
    sites.clear();
    missing = full = 0;
    return mean;
  }
};

}  // namespace

SheetBlockGrid::SheetBlockGrid(Size frame, int side_px)
    : block_px(side_px), columns(frame.width / side_px), rows(frame.height / side_px) {
  blocks.resize(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
}

void average_row(SheetBlockGrid& grid, int row, View<const float> band, const CfaPattern& cfa) {
  const int side = grid.block_px;
  const double middle = (side - 1) / 2.0;
  std::array<Gathered, 3> channels;
  for (int column = 0; column < grid.columns; ++column) {
    for (int y = 0; y < side; ++y) {
      const float* readings = band.row(y) + column * side;
      for (int x = 0; x < side; ++x) {
        const auto c = static_cast<std::size_t>(cfa.channel_at(column * side + x, row * side + y));
        channels[c].add(x - middle, y - middle, readings[x]);
      }
    }
    for (int c = 0; c < 3; ++c) grid.at(column, row, c) = channels[static_cast<std::size_t>(c)].take();
  }
}

void average_row(SheetBlockGrid& grid, int row, const std::array<View<const float>, 3>& band) {
  const int side = grid.block_px;
  const double middle = (side - 1) / 2.0;
  Gathered gathered;
  for (int c = 0; c < 3; ++c) {
    for (int column = 0; column < grid.columns; ++column) {
      for (int y = 0; y < side; ++y) {
        const float* readings = band[static_cast<std::size_t>(c)].row(y) + column * side;
        for (int x = 0; x < side; ++x) gathered.add(x - middle, y - middle, readings[x]);
      }
      grid.at(column, row, c) = gathered.take();
    }
  }
}

MergedBlock merge(const SheetBlockGrid& grid, std::span<const std::array<int, 2>> places) {
  MergedBlock merged;
  std::array<std::vector<Site>, 3> sites;
  std::array<double, 3> variance = {};
  for (const auto& [column, row] : places) {
    const bool whole = std::isfinite(grid.at(column, row, 0).reading + grid.at(column, row, 1).reading +
                                     grid.at(column, row, 2).reading);
    if (!whole) continue;
    ++merged.blocks;
    merged.x_px += grid.centre_px(column);
    merged.y_px += grid.centre_px(row);
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const BlockMean& block = grid.at(column, row, c);
      sites[channel].push_back({static_cast<double>(column - places.front()[0]),
                                static_cast<double>(row - places.front()[1]), block.reading});
      variance[channel] +=
          static_cast<double>(block.standard_error) * static_cast<double>(block.standard_error);
    }
  }
  if (merged.blocks == 0) return merged;
  const auto n = static_cast<double>(merged.blocks);
  merged.x_px /= n;
  merged.y_px /= n;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (const Site& s : sites[c]) sum += s.reading;
    merged.reading_rgb[c] = sum / n;
    double sigma = std::sqrt(variance[c]) / n;
    if (merged.blocks > 3)
      sigma = std::max(sigma, scatter_about(plane_through(sites[c]), sites[c]) / std::sqrt(n));
    merged.relative_sigma[c] = sigma / merged.reading_rgb[c];
  }
  return merged;
}

}  // namespace weft::calibration
