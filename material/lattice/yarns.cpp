// SPDX-License-Identifier: Apache-2.0
#include "material/lattice/yarns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <vector>

#include "core/solve_record.h"
#include "core/vec.h"

namespace weft::material {
namespace {

constexpr double kFarthest_deg = 20;  ///< of a way from its yarn, and of the yarns from upright
constexpr double kSureOfYarn = 6;

// The mean of squared slopes times exp(2i angle) and exp(4i angle), the mean slope taken out.
struct Harmonics {
  std::complex<double> second, fourth;

  double energy(double angle) const {
    return std::real(second * std::polar(1.0, -2 * angle)) + std::real(fourth * std::polar(1.0, -4 * angle));
  }
};

Harmonics harmonics_of(const Surface& surface, Rect crop) {
  std::complex<double> mean;
  const auto slope = [&](int x, int y) {
    return std::complex<double>(surface.slope(x, y, 0), surface.slope(x, y, 1));
  };
  for (int y = crop.y0; y < crop.y1; ++y) {
    for (int x = crop.x0; x < crop.x1; ++x) mean += slope(x, y) / static_cast<double>(crop.pixels());
  }
  Harmonics harmonics;
  for (int y = crop.y0; y < crop.y1; ++y) {
    for (int x = crop.x0; x < crop.x1; ++x) {
      if ((surface.status(x, y) & kNoSolution) != 0) continue;
      const std::complex<double> s = slope(x, y) - mean;
      const double energy = std::norm(s);
      if (!(energy > 0)) continue;
      harmonics.second += s * s;
      harmonics.fourth += s * s * s * s / energy;
    }
  }
  return harmonics;
}

// Of two directions, 0 to 90.
double angle_between_deg(double a, double b) {
  const double d = std::fmod(std::abs(a - b), 180.0);
  return std::min(d, 180 - d);
}

double direction_deg(Vec2 way) {
  return degrees(std::atan2(way.y, way.x));
}

double dear(double off_deg) {
  constexpr double kAsMuchAsLength_deg = 4;
  const double times = off_deg / kAsMuchAsLength_deg;
  return 1 + times * times;
}

// Ways of the lattice near a direction, each with its length times what it is off.
struct Candidate {
  Vec2 way;
  double cost;
};

std::vector<Candidate> ways_near(const Cell& cell, double along_deg) {
  constexpr int kMostMultiple = 24;
  std::vector<Candidate> out;
  for (int j = 0; j <= kMostMultiple; ++j) {
    for (int i = j == 0 ? 1 : -kMostMultiple; i <= kMostMultiple; ++i) {
      const Vec2 way = cell.at(i, j);
      const double off = angle_between_deg(direction_deg(way), along_deg);
      if (off < kFarthest_deg) out.push_back({way, length(way) * dear(off)});
    }
  }
  return out;
}

YarnDirections directions_of_slopes(const Surface& surface, Rect crop) {
  const Harmonics harmonics = harmonics_of(surface, crop);
  const auto steepest = [&](int from_deg, int to_deg) {
    int best = from_deg;
    for (int i = from_deg; i <= to_deg; ++i) {
      if (harmonics.energy(radians(i)) > harmonics.energy(radians(best))) best = i;
    }
    return best;
  };
  const int first = steepest(0, 179);
  int second = steepest(first + 70, first + 110);
  // A maximum on the rim of what is searched is only the flank of the first.
  if (second == first + 70 || second == first + 110) second = first + 90;
  return {(first + 90) % 180 * 1.0, (second + 90) % 180 * 1.0};
}

// How surely the correlation at multiples of one repeat stands above that at the repeats beside them.
struct Ridge {
  double direction_deg = 0, t = 0;
};

double t_of_ridge(Vec2 way, const Cell& cell, const Correlation& correlation) {
  constexpr int kLeastMultiples = 3;
  const std::array<Vec2, 8> beside = {cell.a,      cell.b,      cell.a + cell.b,        cell.a - cell.b,
                                      -1 * cell.a, -1 * cell.b, -1 * (cell.a + cell.b), cell.b - cell.a};
  double n = 0, sum = 0, squares = 0;
  for (int times = 1; length(times * way) < 0.7 * correlation.reach(); ++times) {
    double highest = -1;
    for (const Vec2& step : beside) {
      if (std::abs(cross(step, way)) > 0.5 * cell.area())
        highest = std::max(highest, correlation.at(times * way + step).value_or(-1));
    }
    const double above = correlation.at(times * way).value_or(-1) - highest;
    n += 1;
    sum += above;
    squares += above * above;
  }
  if (n < kLeastMultiples) return 0;
  const double mean = sum / n, variance = std::max((squares - n * mean * mean) / (n - 1), 1e-8);
  return mean / std::sqrt(variance / n);
}

std::vector<Ridge> ridges_of(const Cell& cell, const Correlations& correlations) {
  constexpr int kMostMultiple = 8;
  std::vector<Ridge> ridges;
  for (int j = 0; j <= kMostMultiple; ++j) {
    for (int i = j == 0 ? 1 : -kMostMultiple; i <= kMostMultiple; ++i) {
      if (std::gcd(i, j) != 1) continue;
      double t = 0;
      for (const Correlation& each : correlations.of)
        t += std::max(t_of_ridge(cell.at(i, j), cell, each), 0.0);
      ridges.push_back({direction_deg(cell.at(i, j)), t});
    }
  }
  return ridges;
}

}  // namespace

YarnDirections yarn_directions(const Surface& surface, Rect crop, const Cell& cell,
                               const Correlations& correlations) {
  const std::vector<Ridge> ridges = ridges_of(cell, correlations);
  const auto surest = [&](auto&& counts) {
    const Ridge* best = nullptr;
    for (const Ridge& each : ridges) {
      if (each.t > kSureOfYarn && counts(each) && (best == nullptr || each.t > best->t)) best = &each;
    }
    return best;
  };
  const Ridge* const first = surest([](const Ridge&) { return true; });
  if (first == nullptr) return directions_of_slopes(surface, crop);
  const Ridge* const second = surest([&](const Ridge& each) {
    return angle_between_deg(each.direction_deg, first->direction_deg) > 90 - kFarthest_deg;
  });
  return {first->direction_deg, second != nullptr ? second->direction_deg : first->direction_deg + 90};
}

Cell cell_along_yarns(const Cell& cell, const YarnDirections& yarns) {
  const auto first = ways_near(cell, yarns.first_deg), second = ways_near(cell, yarns.second_deg);
  Vec2 a = cell.a, b = cell.b;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& u : first) {
    for (const Candidate& v : second) {
      const double off = 90 - angle_between_deg(direction_deg(u.way), direction_deg(v.way));
      const double cost = u.cost * v.cost * dear(off);
      if (cost < least) a = u.way, b = v.way, least = cost;
    }
  }
  const auto slant = [](Vec2 v) { return std::abs(v.x) / length(v); };
  if (slant(b) > slant(a)) std::swap(a, b);
  if (a.x < 0) a = -1 * a;
  if (cross(a, b) < 0) b = -1 * b;
  return {a, b};
}

}  // namespace weft::material
