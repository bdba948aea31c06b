// SPDX-License-Identifier: Apache-2.0
#include "material/finish/closed_cut.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace weft::material {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// Costs of the best ways down to each column of the last row, and by which neighbour each place was reached.
struct Ways {
  std::vector<double> cost;
  Image<std::int8_t> from;
};

// Ways from column `start` of the first row, or from any where it is below 0.
Ways ways_down(View<const float> cost, int margin, int start) {
  const int width = cost.width();
  Ways ways = {std::vector<double>(static_cast<std::size_t>(width), kNever), Image<std::int8_t>(cost.size())};
  const auto at = [&](std::vector<double>& values, int x) -> double& {
    return values[static_cast<std::size_t>(x)];
  };
  for (int x = margin; x < width - margin; ++x) {
    if (start < 0 || x == start) at(ways.cost, x) = static_cast<double>(cost(x, 0));
  }
  std::vector<double> next(ways.cost.size());
  for (int y = 1; y < cost.height(); ++y) {
    std::ranges::fill(next, kNever);
    for (int x = margin; x < width - margin; ++x) {
      int best = 0;
      for (const int d : {-1, 1}) {
        if (x + d >= margin && x + d < width - margin && at(ways.cost, x + d) < at(ways.cost, x + best))
          best = d;
      }
      at(next, x) = at(ways.cost, x + best) + static_cast<double>(cost(x, y));
      ways.from(x, y) = static_cast<std::int8_t>(best);
    }
    ways.cost.swap(next);
  }
  return ways;
}

std::vector<int> traced(const Ways& ways, int end) {
  const int height = ways.from.height();
  std::vector<int> column(static_cast<std::size_t>(height), end);
  for (int y = height - 1; y > 0; --y) {
    const int x = column[static_cast<std::size_t>(y)];
    column[static_cast<std::size_t>(y - 1)] = x + ways.from(x, y);
  }
  return column;
}

}  // namespace

Cut least_cut(View<const float> cost, int margin, int starts) {
  Cut best;
  double least = kNever;
  const int first = margin, last = cost.width() - margin - 1;
  for (int i = 0; i < starts; ++i) {
    const int start =
        first + static_cast<int>(static_cast<std::int64_t>(last - first) * i / std::max(starts - 1, 1));
    const Ways ways = ways_down(cost, margin, start);
    for (int end = std::max(start - 1, first); end <= std::min(start + 1, last); ++end) {
      const double total = ways.cost[static_cast<std::size_t>(end)];
      if (!(total < least)) continue;
      least = total;
      best = {traced(ways, end), total / cost.height()};
    }
  }
  return best;
}

double least_open_cost(View<const float> cost, int margin) {
  const Ways ways = ways_down(cost, margin, -1);
  return *std::ranges::min_element(ways.cost) / cost.height();
}

}  // namespace weft::material
