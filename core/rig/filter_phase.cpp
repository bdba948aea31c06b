// SPDX-License-Identifier: Apache-2.0
#include "core/rig/filter_phase.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/statistics.h"

namespace weft {
namespace {

constexpr double kDark = 0.02, kFull = 0.95;  // of the way from black to white
constexpr double kDiffers = 0.1;              // log of light
constexpr double kFitsBetter = 4;             // times
constexpr std::size_t kFewestCells = 1000, kMostCellsSeen = 40000;
constexpr std::size_t kFewestOthers = 3;

double distance(const SiteLight& a, const SiteLight& b, std::size_t row, std::size_t column) {
  double most = 0;
  for (std::size_t y = 0; y < 2; ++y)
    for (std::size_t x = 0; x < 2; ++x) most = std::max(most, std::abs(a[y][x] - b[y ^ row][x ^ column]));
  return most;
}

SiteLight median_of(const std::vector<SiteLight>& all) {
  SiteLight middle;
  for (std::size_t y = 0; y < 2; ++y)
    for (std::size_t x = 0; x < 2; ++x) {
      std::vector<double> values;
      for (const SiteLight& each : all) values.push_back(each[y][x]);
      middle[y][x] = median(std::move(values));
    }
  return middle;
}

FilterShift against(const SiteLight& one, const SiteLight& others) {
  const double as_it_is = distance(one, others, 0, 0);
  const auto fits = [&](std::size_t row, std::size_t column) {
    return as_it_is > kDiffers && distance(one, others, row, column) * kFitsBetter < as_it_is;
  };
  return fits(1, 0) ? FilterShift::kRow : fits(0, 1) ? FilterShift::kColumn : FilterShift::kNone;
}

bool greens_are_red_and_blue(const SiteLight& light, const CfaPattern& cfa) {
  std::array<double, 4> by_site = {};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x)
      by_site[cfa.site_at(x, y)] = light[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  const double greens = std::abs(by_site[1] - by_site[3]), others = std::abs(by_site[0] - by_site[2]);
  return greens > kDiffers && others * kFitsBetter < greens;
}

}  // namespace

std::optional<SiteLight> site_light(const RawFrame& frame) {
  const Size size = frame.counts.size();
  const auto cells = static_cast<std::size_t>(size.pixels()) / 4;
  const int step = 2 * static_cast<int>(1 + std::sqrt(static_cast<double>(cells / kMostCellsSeen)));
  std::array<std::array<std::vector<double>, 2>, 2> logs;
  for (int y = 0; y + 1 < size.height; y += step)
    for (int x = 0; x + 1 < size.width; x += step) {
      SiteLight cell;
      double mean = 0;
      bool is_good = true;
      for (std::size_t j = 0; j < 2; ++j)
        for (std::size_t i = 0; i < 2; ++i) {
          const double black = static_cast<double>(frame.black[j][i]);
          const double v = (frame.counts(x + static_cast<int>(i), y + static_cast<int>(j)) - black) /
                           (static_cast<double>(frame.white) - black);
          is_good = is_good && v > kDark && v < kFull;
          cell[j][i] = is_good ? std::log(v) : 0;
          mean += cell[j][i] / 4;
        }
      for (std::size_t j = 0; is_good && j < 2; ++j)
        for (std::size_t i = 0; i < 2; ++i) logs[j][i].push_back(cell[j][i] - mean);
    }
  if (logs[0][0].size() < kFewestCells) return {};
  SiteLight light;
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t i = 0; i < 2; ++i) light[j][i] = median(std::move(logs[j][i]));
  return light;
}

std::vector<FilterShift> filter_shifts(std::span<const std::optional<SiteLight>> mosaics,
                                       const CfaPattern& cfa) {
  std::vector<FilterShift> shifts(mosaics.size(), FilterShift::kNone);
  std::vector<SiteLight> all;
  for (const auto& each : mosaics)
    if (each) all.push_back(*each);
  if (all.empty()) return shifts;
  const SiteLight middle = median_of(all);
  const bool all_lie_off = greens_are_red_and_blue(middle, cfa);
  for (std::size_t k = 0; k < mosaics.size(); ++k) {
    if (!mosaics[k]) continue;
    if (all_lie_off)
      shifts[k] = FilterShift::kRowOrColumn;
    else if (all.size() > kFewestOthers)
      shifts[k] = against(*mosaics[k], middle);
  }
  return shifts;
}

}  // namespace weft
