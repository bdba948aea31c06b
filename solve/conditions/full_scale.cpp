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

namespace weft::solve {
namespace {

constexpr std::int64_t kFewestFull = 100;  // samples of all photographs
constexpr std::int64_t kFewestInOne = 20;  // of a photograph, for it to count
constexpr double kMostOfOne = 0.5;         // of a photograph's samples: more is a surface of one value
constexpr double kBelow = 0.8;             // of the largest value
constexpr int kPile = 3;                   // times as many as any value below has
constexpr std::size_t kBins = 4096;        // from kBelow to the largest value

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

// How often a plane has the largest value, and those below.
struct Top {
  std::int64_t full = 0;
  std::vector<std::int64_t> below = std::vector<std::int64_t>(kBins);
};

Top top_of(View<const float> plane, float largest) {
  Top top;
  const double scale = kBins / ((1 - kBelow) * static_cast<double>(largest));
  const double from = kBelow * static_cast<double>(largest);
  for (int y = 0; y < plane.height(); ++y) {
    const float* row = plane.row(y);
    for (int x = 0; x < plane.width(); ++x) {
      const double value = static_cast<double>(row[x]);
      if (!(value >= from) || !std::isfinite(value)) continue;
      if (row[x] == largest) {
        ++top.full;
        continue;
      }
      ++top.below[std::min(kBins - 1, static_cast<std::size_t>((value - from) * scale))];
    }
  }
  return top;
}

bool is_a_pile(const std::vector<Top>& tops, std::int64_t pixels) {
  std::int64_t full = 0;
  int photographs = 0;
  std::vector<std::int64_t> below(kBins);
  for (const Top& top : tops) {
    if (static_cast<double>(top.full) > kMostOfOne * static_cast<double>(pixels)) return false;
    full += top.full;
    photographs += top.full >= kFewestInOne;
    std::ranges::transform(top.below, below, below.begin(), std::plus());
  }
  return full >= kFewestFull && photographs > 1 && full > kPile * std::ranges::max(below);
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
    std::vector<Top> tops(photographs.size());
    parallel_for(tops.size(), exposures.context.threads, [&](std::size_t k, int) {
      if (each[k] >= static_cast<float>(kBelow) * largest) tops[k] = top_of(photographs[k].plane(c), largest);
      developed->page_out(k);
    });
    if (!is_a_pile(tops, exposures.photographs.size.pixels())) continue;
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
