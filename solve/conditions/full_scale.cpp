// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/full_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "core/base/parallel.h"
#include "core/rig/reading_stop.h"

namespace weft::solve {
namespace {

constexpr StopRules kStop = {0, 0.5};     // more than half of a photograph at one value is a surface
constexpr double kBelow = 0.8;            // of the largest value
constexpr std::uint32_t kLevels = 20480;  // from 0 to the largest value, which alone has the last

float largest_in(View<const float> plane) {
  float largest = 0;
  for (int y = 0; y < plane.height(); ++y) {
    const float* row = plane.row(y);
    for (int x = 0; x < plane.width(); ++x) {
      if (row[x] > largest && std::isfinite(row[x])) largest = row[x];
    }
  }
  return largest;
}

TopTally tally_of(View<const float> plane, float largest) {
  const double scale = kLevels / static_cast<double>(largest), from = kBelow * static_cast<double>(largest);
  TopTally tally = {static_cast<std::uint32_t>(kBelow * kLevels), {}, plane.size().pixels()};
  tally.counts.resize(kLevels - tally.first + 1);
  for (int y = 0; y < plane.height(); ++y) {
    const float* row = plane.row(y);
    for (int x = 0; x < plane.width(); ++x) {
      const double value = static_cast<double>(row[x]);
      if (!(value >= from) || !std::isfinite(value)) continue;
      const std::uint32_t level =
          row[x] == largest ? kLevels : std::min(kLevels - 1, static_cast<std::uint32_t>(value * scale));
      ++tally.counts[std::max(level, tally.first) - tally.first];
    }
  }
  return tally;
}

void mark(View<float> plane, float largest) {
  for (int y = 0; y < plane.height(); ++y) {
    float* row = plane.row(y);
    std::replace(row, row + plane.width(), largest, std::numeric_limits<float>::infinity());
  }
}

}  // namespace

Result<void> find_full_scale(const Exposures& exposures) {
  auto* developed = std::get_if<Developed>(&exposures.photographs.frames);
  if (developed == nullptr || exposures.plan.is_of_rig || exposures.plan.clipped == Clipped::kKeep) return {};
  std::vector<Image<float>>& photographs = developed->rgb;
  std::array<float, 3> found = {};
  for (int c = 0; c < 3; ++c) {
    std::vector<float> each(photographs.size());
    parallel_for(each.size(), exposures.context.threads, [&](std::size_t k, int) {
      each[k] = largest_in(photographs[k].plane(c));
      developed->page_out(k);
    });
    const float largest = std::ranges::max(each);
    if (!(largest > 0)) continue;
    std::vector<TopTally> tops(photographs.size());
    parallel_for(tops.size(), exposures.context.threads, [&](std::size_t k, int) {
      if (each[k] >= static_cast<float>(kBelow) * largest)
        tops[k] = tally_of(photographs[k].plane(c), largest);
      developed->page_out(k);
    });
    if (find_stop(tops, kStop) != double{kLevels}) continue;
    found[static_cast<std::size_t>(c)] = largest;
    parallel_for(photographs.size(), exposures.context.threads, [&](std::size_t k, int) {
      mark(photographs[k].plane(c), largest);
      developed->page_out(k);
    });
  }
  if (found != std::array<float, 3>{}) {
    exposures.photographs.conditions.assumed.push_back(fmt::format(
        "light above {:.4g} of the files' full scale is taken as clipped there, where many samples "
        "stop",
        std::ranges::max(found)));
  }
  return {};
}

}  // namespace weft::solve
