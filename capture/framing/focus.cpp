// SPDX-License-Identifier: Apache-2.0
#include "capture/framing/focus.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace weft::capture {
namespace {

constexpr double kNoiseShare = 24.0 / 64;  // of a photosite's variance, in both gradients together
constexpr double kLeastMean = 0.005;       // of full scale: what is darker is too dark to tell
constexpr double kMostFull = 0.01;         // of a cell's green photosites
constexpr double kFullFrom = 0.98;         // of full scale
constexpr std::size_t kLeastShots = 3;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Sums over the green photosites of a cell.
struct GreenSums {
  double gradients = 0, light = 0;
  std::int64_t count = 0, full = 0;
};

GreenSums sums_in(const RawFrame& frame, Rect cell) {
  const View<const std::uint16_t> counts = frame.counts.plane();
  const double full = kFullFrom * static_cast<double>(frame.white);
  GreenSums sums;
  for (int y = cell.y0; y < cell.y1; ++y) {
    for (int x = cell.x0; x < cell.x1; ++x) {
      if (frame.cfa.channel_at(x, y) != 1) continue;
      const auto at = [&](int dx, int dy) { return static_cast<double>(counts(x + dx, y + dy)); };
      const double black =
          static_cast<double>(frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
      const double u = (2 * (at(1, 1) - at(-1, -1)) + at(2, 0) - at(-2, 0) + at(0, 2) - at(0, -2)) / 8;
      const double v = (2 * (at(1, -1) - at(-1, 1)) + at(2, 0) - at(-2, 0) + at(0, -2) - at(0, 2)) / 8;
      sums.gradients += u * u + v * v;
      sums.light += at(0, 0) - black;
      sums.full += at(0, 0) >= full ? 1 : 0;
      ++sums.count;
    }
  }
  return sums;
}

double sharpness_of(const GreenSums& sums, const RawFrame& frame,
                    const std::optional<PhotositeNoise>& noise) {
  if (sums.count == 0) return kNone;
  const double count = static_cast<double>(sums.count), mean = sums.light / count;
  const double range = static_cast<double>(frame.white) - static_cast<double>(frame.black[0][0]);
  if (mean < kLeastMean * range || static_cast<double>(sums.full) > kMostFull * count) return kNone;
  const double variance =
      noise ? mean / noise->electrons_per_count + noise->read_noise_counts * noise->read_noise_counts : 0;
  return std::max(sums.gradients / count - kNoiseShare * variance, 0.0) / (mean * mean);
}

double mean_of(const FocusMap::Cells& cells) {
  double sum = 0, count = 0;
  for (const double cell : cells) {
    if (!std::isfinite(cell)) continue;
    sum += cell;
    ++count;
  }
  return count > 0 ? sum / count : kNone;
}

/// The rise of a plane through the logarithms of the cells, from one edge to the other: least squares over a
/// grid, whose columns and rows are independent where no cell is missing, and nearly so where few are.
std::optional<double> rise(const FocusMap::Cells& cells, bool across) {
  const int steps = across ? FocusMap::kColumns : FocusMap::kRows;
  double xx = 0, xy = 0, x_sum = 0, y_sum = 0, count = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!(cells[i] > 0)) continue;
    const int at = static_cast<int>(i);
    const double x = 2.0 * (across ? at % FocusMap::kColumns : at / FocusMap::kColumns) / (steps - 1) - 1;
    const double y = std::log(cells[i]);
    x_sum += x;
    y_sum += y;
    xx += x * x;
    xy += x * y;
    ++count;
  }
  if (count < static_cast<double>(cells.size()) / 2) return std::nullopt;
  const double spread = xx - x_sum * x_sum / count;
  if (!(spread > 0)) return std::nullopt;
  return std::expm1(2 * (xy - x_sum * y_sum / count) / spread);
}

}  // namespace

FocusMap focus_of(const RawFrame& frame, const std::optional<PhotositeNoise>& noise) {
  constexpr int kReach = 2;  // of the operator
  const Size size = frame.counts.size();
  const int width = size.width - 2 * kReach, height = size.height - 2 * kReach;
  FocusMap map;
  for (int row = 0; row < FocusMap::kRows; ++row) {
    for (int column = 0; column < FocusMap::kColumns; ++column) {
      const auto part = [](int length, int i, int of) {
        return kReach + static_cast<int>(static_cast<std::int64_t>(std::max(length, 0)) * i / of);
      };
      const Rect cell = {part(width, column, FocusMap::kColumns), part(height, row, FocusMap::kRows),
                         part(width, column + 1, FocusMap::kColumns), part(height, row + 1, FocusMap::kRows)};
      map.cells[static_cast<std::size_t>(row * FocusMap::kColumns + column)] =
          sharpness_of(sums_in(frame, cell), frame, noise);
    }
  }
  map.score = mean_of(map.cells);
  return map;
}

FocusStanding FocusSeries::add(const FocusMap& map) {
  maps_.push_back(map);
  if (maps_.size() > kKept) maps_.pop_front();
  FocusStanding standing;
  FocusMap::Cells most = {};
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    standing.scores.push_back(maps_[i].score);
    const double best = standing.scores[standing.best];
    if (standing.scores[i] > best || std::isnan(best)) standing.best = i;
    for (std::size_t c = 0; c < most.size(); ++c) {
      if (maps_[i].cells[c] > most[c]) most[c] = maps_[i].cells[c];
    }
  }
  for (std::size_t c = 0; c < most.size(); ++c)
    standing.relative[c] = most[c] > 0 ? map.cells[c] / most[c] : kNone;
  if (maps_.size() < kLeastShots) return standing;
  standing.more_right = rise(standing.relative, true);
  standing.more_below = rise(standing.relative, false);
  return standing;
}

}  // namespace weft::capture
