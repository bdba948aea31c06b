// SPDX-License-Identifier: Apache-2.0
#include "solver/sanity/surface_witnesses.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/statistics.h"

namespace weft::solver {
namespace {

constexpr double kNoSlope = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kFewestCorners = 100, kFewestAtEdge = 20;
constexpr double kSteepest = 0.3;  // nz: beyond it slopes are mostly noise

struct Solved {
  double p = kNoSlope, q = kNoSlope;
  Vec3 scaled;  // albedo times normal
};

// From the lights that are not in shadow.
Solved solve_block(const BlockTile& tile, std::size_t block) {
  const std::span<const float> readings = tile.of(block);
  double mean = 0, known = 0;
  for (const float reading : readings) {
    if (!std::isfinite(reading)) continue;
    mean += static_cast<double>(reading);
    ++known;
  }
  mean /= known;
  if (!(mean > 0)) return {};
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int lit = 0;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double value = static_cast<double>(readings[k]);
    if (!(value >= kLeastLit * mean)) continue;
    const Vec3 toward = tile.light(block, k);
    const Eigen::Vector3d light(toward.x, toward.y, toward.z);
    normal += light * light.transpose();
    right += value * light;
    ++lit;
  }
  if (lit < 3 || !(normal.determinant() > 1e-6 * std::pow(normal.trace(), 3))) return {};
  const Eigen::Vector3d g = normal.ldlt().solve(right);
  if (!g.allFinite() || !(g.z() > kSteepest * g.norm())) return {};
  return {-g.x() / g.z(), -g.y() / g.z(), {g.x(), g.y(), g.z()}};
}

std::vector<Solved> solve_tile(const BlockTile& tile) {
  std::vector<Solved> solved(tile.blocks());
  for (std::size_t block = 0; block < solved.size(); ++block) solved[block] = solve_block(tile, block);
  return solved;
}

// dp/dx, dp/dy, dq/dx, dq/dy, with y up, around the corner between four blocks.
std::array<double, 4> derivatives_at(const std::vector<Solved>& solved, int width, int x, int y) {
  const auto at = [&](int ax, int ay) { return solved[static_cast<std::size_t>(ay * width + ax)]; };
  const Solved nw = at(x, y), ne = at(x + 1, y), sw = at(x, y + 1), se = at(x + 1, y + 1);
  return {(ne.p + se.p - nw.p - sw.p) / 2, (nw.p + ne.p - sw.p - se.p) / 2, (ne.q + se.q - nw.q - sw.q) / 2,
          (nw.q + ne.q - sw.q - se.q) / 2};
}

double mean_without_largest(std::vector<double>& values) {
  constexpr double kKept = 0.8;
  if (values.size() < kFewestCorners) return kNoSlope;
  const auto end = values.begin() + static_cast<std::ptrdiff_t>(kKept * static_cast<double>(values.size()));
  std::nth_element(values.begin(), end, values.end());
  double sum = 0;
  for (auto at = values.begin(); at != end; ++at) sum += *at;
  return sum / static_cast<double>(end - values.begin());
}

// The steepest way up from a block to what lies in a direction, over the distance: heights are sums of
// slopes.
double steepest_towards(const std::vector<Solved>& solved, const BlockTile& tile, int x, int y, double dx,
                        double dy, double sign) {
  constexpr int kReach = 16;
  double height = 0, steepest = -std::numeric_limits<double>::infinity();
  const auto slope_at = [&](int s) {
    const long ax = std::lround(x + s * dx), ay = std::lround(y - s * dy);
    if (ax < 0 || ay < 0 || ax >= tile.width || ay >= tile.height) return kNoSlope;
    const Solved& there = solved[static_cast<std::size_t>(ay * tile.width + ax)];
    return sign * (there.p * dx + there.q * dy);
  };
  double before = slope_at(0);
  for (int s = 1; s <= kReach; ++s) {
    const double after = slope_at(s);
    if (!std::isfinite(after)) break;
    height += 0.5 * (before + after);
    steepest = std::max(steepest, height / s);
    before = after;
  }
  return steepest;
}

struct Covered {
  std::size_t of = 0, covered = 0;
  void add(bool is_covered) {
    ++of;
    covered += is_covered ? 1 : 0;
  }
  double share() const { return of == 0 ? 0 : static_cast<double>(covered) / static_cast<double>(of); }
};

// What stands before dark blocks and before lit ones.
struct Sight {
  Covered dark, lit;
  double gain() const { return dark.share() - lit.share(); }
};

// Under one light, if it is one that a shadow may be cast by.
void look_from(const BlockTile& tile, const std::vector<Solved>& solved, std::size_t block, std::size_t k,
               Sight& given, Sight& other, std::size_t& turn) {
  constexpr double kDark = 0.5;      // of what the normal makes of it
  constexpr double kFacing = 0.25;   // of what faces the light: less is no cast shadow
  constexpr std::size_t kEvery = 7;  // of the lit blocks
  const Solved& here = solved[block];
  const Vec3 light = tile.light(block, k);
  const double predicted = dot(here.scaled, light), flat = std::hypot(light.x, light.y);
  if (predicted < kFacing * length(here.scaled) * length(light) || flat < 1e-3 * light.z) return;
  const bool is_dark = static_cast<double>(tile.of(block)[k]) < kDark * predicted;
  if (!is_dark && turn++ % kEvery != 0) return;
  const double rise = light.z / flat, dx = light.x / flat, dy = light.y / flat;
  const int x = static_cast<int>(block) % tile.width, y = static_cast<int>(block) / tile.width;
  (is_dark ? given.dark : given.lit).add(steepest_towards(solved, tile, x, y, dx, dy, 1) > rise);
  (is_dark ? other.dark : other.lit).add(steepest_towards(solved, tile, x, y, -dx, -dy, -1) > rise);
}

// Which way lies outside of the thing, from a block that is its last; 0 within.
Vec3 outwards(const BlockTile& tile, int x, int y) {
  Vec3 out;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const auto block = static_cast<std::size_t>((y + dy) * tile.width + x + dx);
      if (!std::isnan(tile.of(block)[0])) continue;
      out.x += dx;
      out.y -= dy;
    }
  }
  return out;
}

}  // namespace

// If the true lights are M times the given ones, with an orthogonal M, the true slopes are M times the solved
// ones.
std::array<double, kSymmetries> curls(std::span<const BlockTile> tiles) {
  std::array<std::vector<double>, kSymmetries> all;
  for (const BlockTile& tile : tiles) {
    const std::vector<Solved> solved = solve_tile(tile);
    for (int y = 0; y + 1 < tile.height; ++y) {
      for (int x = 0; x + 1 < tile.width; ++x) {
        const auto [px, py, qx, qy] = derivatives_at(solved, tile.width, x, y);
        if (!std::isfinite(px + py + qx + qy)) continue;
        all[0].push_back(std::abs(py - qx));  // (p, q)
        all[1].push_back(std::abs(py + qx));  // (p, -q)
        all[2].push_back(std::abs(qy + px));  // (q, -p)
        all[3].push_back(std::abs(qy - px));  // (q, p)
      }
    }
  }
  std::array<double, kSymmetries> means = {};
  std::ranges::transform(all, means.begin(), mean_without_largest);
  return means;
}

Sides shadows_explained(std::span<const BlockTile> tiles) {
  Sight given, other;
  std::size_t turn = 0;
  for (const BlockTile& tile : tiles) {
    const std::vector<Solved> solved = solve_tile(tile);
    for (std::size_t block = 0; block < solved.size(); ++block) {
      if (!std::isfinite(solved[block].p)) continue;
      for (std::size_t k = 0; k < tile.count; ++k) look_from(tile, solved, block, k, given, other, turn);
    }
  }
  return {given.gain(), other.gain(), given.dark.of};
}

double falls_at_edge(std::span<const BlockTile> tiles) {
  double sum = 0, size = 0;
  std::size_t count = 0;
  for (const BlockTile& tile : tiles) {
    const std::vector<Solved> solved = solve_tile(tile);
    for (int y = 1; y + 1 < tile.height; ++y) {
      for (int x = 1; x + 1 < tile.width; ++x) {
        const Solved& here = solved[static_cast<std::size_t>(y * tile.width + x)];
        const Vec3 out = outwards(tile, x, y);
        if (!std::isfinite(here.p) || !(length(out) > 0)) continue;
        sum -= (here.p * out.x + here.q * out.y) / length(out);
        size += std::hypot(here.p, here.q);
        ++count;
      }
    }
  }
  return count < kFewestAtEdge || !(size > 0) ? kNoSlope : sum / size;
}

// Over-relaxation: a tile is some thirty blocks wide.
std::vector<double> heights_of(const BlockTile& tile) {
  constexpr int kSweeps = 100;
  constexpr double kRelaxed = 1.7;
  const std::vector<Solved> solved = solve_tile(tile);
  std::vector<double> heights(solved.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) {
        const auto here = static_cast<std::size_t>(y * tile.width + x);
        if (!std::isfinite(solved[here].p)) continue;
        double sum = 0, count = 0;
        const auto from = [&](int ax, int ay, double step) {
          if (ax < 0 || ay < 0 || ax >= tile.width || ay >= tile.height) return;
          const auto there = static_cast<std::size_t>(ay * tile.width + ax);
          if (!std::isfinite(solved[there].p)) return;
          const bool is_across = ay == y;
          sum +=
              heights[there] +
              step * 0.5 * (is_across ? solved[here].p + solved[there].p : solved[here].q + solved[there].q);
          ++count;
        };
        from(x - 1, y, 1), from(x + 1, y, -1), from(x, y + 1, 1), from(x, y - 1, -1);
        if (count > 0) heights[here] += kRelaxed * (sum / count - heights[here]);
      }
    }
  }
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (std::isfinite(solved[i].p)) sum += heights[i], ++count;
  }
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (std::isfinite(solved[i].p)) heights[i] -= sum / count;
  }
  return heights;
}

}  // namespace weft::solver
