// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/sheet_stories.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace weft::calibration {
namespace {

constexpr double kFarBetter = 0.25;  // of the squares
constexpr double kLeastRms = 0.01;   // what a tape that is off by a few millimetres does
constexpr double kFirstShare = 0.04, kFinerShare = 0.015;
constexpr int kQuickIterations = 8;
constexpr double kLeastShare = -0.6, kMostShare = 0.8;
constexpr double kStorySigmas = 5, kExplained = 0.5;

using Tried = std::pair<double, double>;  // a share, and the cost of the fit with it

// Mean square of ln(reading / model) of each LED's readings (row) as if it stood at each place (column).
std::vector<std::vector<double>> squares_by_place(const PaperScene& start,
                                                  std::span<const PaperReading> readings) {
  const std::size_t n = start.lights.leds.size();
  struct Sums {
    std::array<double, 3> sum = {}, square = {};
    double count = 0;
    bool is_lit = true;
  };
  std::vector<std::vector<Sums>> sums(n, std::vector<Sums>(n));
  for (const PaperReading& r : readings) {
    const LineOfSight sight = sight_of(start.camera, r.x_px, r.y_px);
    for (std::size_t place = 0; place < n; ++place) {
      Sums& s = sums[r.led][place];
      const auto term =
          paper_term(sight, start.lights.leds[place], start.paper, start.sheets[r.sheet].rig_from_sheet);
      s.is_lit = s.is_lit && term;
      if (!term) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const double residual = std::log(r.reading_rgb[c]) - term->log_value;
        s.sum[c] += residual, s.square[c] += residual * residual;
      }
      ++s.count;
    }
  }
  std::vector<std::vector<double>> squares(n,
                                           std::vector<double>(n, std::numeric_limits<double>::infinity()));
  for (std::size_t led = 0; led < n; ++led) {
    for (std::size_t place = 0; place < n; ++place) {
      const Sums& s = sums[led][place];
      if (!s.is_lit || s.count < 2) continue;
      squares[led][place] = 0;
      for (std::size_t c = 0; c < 3; ++c)
        squares[led][place] += (s.square[c] - s.sum[c] * s.sum[c] / s.count) / s.count / 3;
    }
  }
  return squares;
}

// Readings without a share of the mean light of all LEDs at their place.
std::vector<PaperReading> without_room(std::span<const PaperReading> readings, double share) {
  std::map<std::tuple<std::size_t, double, double>, std::array<double, 4>> sums;
  for (const PaperReading& r : readings) {
    auto& sum = sums[{r.sheet, r.x_px, r.y_px}];
    for (std::size_t c = 0; c < 3; ++c) sum[c] += r.reading_rgb[c];
    ++sum[3];
  }
  std::vector<PaperReading> out(readings.begin(), readings.end());
  for (PaperReading& r : out) {
    const auto& sum = sums[{r.sheet, r.x_px, r.y_px}];
    // The mean that was read has that light in it.
    for (std::size_t c = 0; c < 3; ++c) r.reading_rgb[c] -= share / (1 + share) * sum[c] / sum[3];
  }
  return out;
}

// Chi-square with shots as like each other as was expected, whatever the fit let them be.
double cost_of(const LightFit& fit, const LightFitOptions& options) {
  double cost = fit.chi_square * fit.degrees_of_freedom;
  for (const auto& sheet : fit.scene.shot_log_gains) {
    for (const double gain : sheet)
      cost += gain * gain * (1 / (options.flicker * options.flicker) - 1 / (fit.flicker * fit.flicker));
  }
  return cost;
}

// Where a parabola through three has its least, and its curvature; nothing where it has none.
std::optional<std::pair<double, double>> vertex_of(Tried a, Tried b, Tried c) {
  const double ab = (b.second - a.second) / (b.first - a.first);
  const double bc = (c.second - b.second) / (c.first - b.first);
  const double curvature = 2 * (bc - ab) / (c.first - a.first);
  if (!(curvature > 0) || !std::isfinite(curvature)) return std::nullopt;
  return std::pair((a.first + b.first) / 2 - ab / curvature, curvature);
}

// The share that costs least, tried from 0 on in steps that grow and at last halve.
template <typename Try>
double nearest_share(const Try& cost_of_share) {
  Tried best = cost_of_share(0);
  double step = kFirstShare;
  const Tried more = cost_of_share(step), less = cost_of_share(-step);
  if (std::min(more.second, less.second) < best.second) {
    if (less.second < more.second) step = -step;
    best = std::min(more, less, [](Tried a, Tried b) { return a.second < b.second; });
    for (Tried next = cost_of_share(best.first + step); next.second < best.second;) {
      best = next;
      step *= 1.5;
      if (best.first + step < kLeastShare || best.first + step > kMostShare) break;
      next = cost_of_share(best.first + step);
    }
  }
  for (step = std::abs(step) / 2; step > kFinerShare / 2; step /= 2) {
    for (const double share : {best.first - step, best.first + step}) {
      if (const Tried next = cost_of_share(share); next.second < best.second) {
        best = next;
        break;
      }
    }
  }
  return best.first;
}

}  // namespace

std::optional<ExchangedLeds> find_exchanged(const PaperScene& start, std::span<const PaperReading> readings) {
  const auto squares = squares_by_place(start, readings);
  ExchangedLeds found;
  double before = 0, after = 0, count = 0;
  for (std::size_t led = 0; led < squares.size(); ++led) {
    const auto best = static_cast<std::size_t>(std::ranges::min_element(squares[led]) - squares[led].begin());
    const double own = squares[led][led];
    const bool is_other = best != led && squares[led][best] < kFarBetter * own && own > kLeastRms * kLeastRms;
    found.as.push_back(is_other ? best : led);
    if (!is_other) continue;
    before += std::min(own, 1.0), after += squares[led][best], ++count;
  }
  if (count == 0) return std::nullopt;
  found.rms_before = std::sqrt(before / count);
  found.rms_after = std::sqrt(after / count);
  return found;
}

std::optional<RoomLight> find_room_light(const PaperScene& start, std::span<const PaperReading> readings,
                                         const LightFitOptions& options, const LightFit& without) {
  std::optional<LightFit> last;
  const auto tried = [&](double share, const LightFitOptions& how) -> Tried {
    Result<LightFit> fit = fit_lights(start, without_room(readings, share), how);
    last = fit ? std::optional(std::move(*fit)) : std::nullopt;
    return {share, last ? cost_of(*last, options) : std::numeric_limits<double>::infinity()};
  };
  LightFitOptions quick = options;  // far from the share a fit crawls, and is far off all the same
  quick.most_iterations = std::min(options.most_iterations, kQuickIterations);
  const double near = nearest_share([&](double share) { return tried(share, quick); });
  const auto vertex =
      vertex_of(tried(near - kFinerShare, options), tried(near, options), tried(near + kFinerShare, options));
  if (!vertex) return std::nullopt;
  const Tried best = tried(std::clamp(vertex->first, near - kFinerShare, near + kFinerShare), options);
  if (!last) return std::nullopt;
  const RoomLight room = {best.first, std::sqrt(2 / vertex->second), last->chi_square, !last->misfits()};
  const bool explains = room.agrees || best.second < kExplained * cost_of(without, options);
  if (!explains || std::abs(room.share) < kStorySigmas * room.sigma) return std::nullopt;
  return room;
}

}  // namespace weft::calibration
