// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/light_assignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/statistics.h"
#include "core/base/vec.h"

namespace weft::capture {
namespace {

// As the evidence of a scan has them (light_evidence.cpp).
constexpr double kMostOfOther = 0.6;      // of the other's misfit, at most
constexpr double kLessThanOther = 0.002;  // and less by this at least
constexpr double kNoMisfit = 0.0005;      // what rounding leaves of frames without noise
constexpr std::size_t kWantedPatches = 300;
constexpr double kLeastMean = 1e-6;  // of full scale: a patch below has no light

using Leds = std::vector<int>;
using Light = std::vector<std::vector<double>>;

/// Steps without a factor in common with 48 columns.
std::size_t step_for(std::size_t patches) {
  std::size_t step = 1;
  for (const std::size_t wider : {5U, 7U, 11U, 13U})
    if (patches / wider >= kWantedPatches) step = wider;
  return step;
}

/// Misfits of assignments, each worked out once.
class Misfits {
 public:
  Misfits(const Light& light, const PatchLights& model)
      : light_(light), model_(model), step_(step_for(light.front().size())) {
    for (const std::vector<double>& frame : light_) frames_.push_back(&frame);
  }

  double of(const Leds& leds) {
    const auto known = known_.find(leds);
    if (known != known_.end()) return known->second;
    std::vector<const std::vector<Vec3>*> incident;
    for (const int led : leds) incident.push_back(&model_.leds[static_cast<std::size_t>(led - 1)]);
    return known_[leds] = fit_light(frames_, incident, step_).misfit;
  }
  const std::map<Leds, double>& known() const { return known_; }

 private:
  const Light& light_;
  const PatchLights& model_;
  std::size_t step_;
  std::vector<const std::vector<double>*> frames_;
  std::map<Leds, double> known_;
};

/// Assignments one step away: two frames exchanged, or a frame under a LED that no frame has.
std::vector<Leds> neighbours_of(const Leds& leds, int count) {
  std::vector<Leds> all;
  for (std::size_t f = 0; f < leds.size(); ++f) {
    for (std::size_t g = f + 1; g < leds.size(); ++g) {
      all.push_back(leds);
      std::swap(all.back()[f], all.back()[g]);
    }
    for (int led = 1; led <= count; ++led) {
      if (std::ranges::find(leds, led) != leds.end()) continue;
      all.push_back(leds);
      all.back()[f] = led;
    }
  }
  return all;
}

/// Where a LED stands as the middle of the frame sees it, on the plane of the table.
std::vector<Vec3> places_of(const PatchLights& model) {
  std::vector<Vec3> places;
  for (const std::vector<Vec3>& led : model.leds) {
    Vec3 sum;
    for (const Vec3& light : led) sum = sum + light;
    const double norm = length(sum);
    places.push_back(norm > 0 ? (1 / norm) * Vec3{sum.x, sum.y, 0} : Vec3());
  }
  return places;
}

/// Turns and mirror images of the lights about the z axis, as the LED that each LED falls on.
std::vector<Leds> symmetries_of(const PatchLights& model) {
  const std::vector<Vec3> places = places_of(model);
  const auto azimuth = [](const Vec3& place) { return std::atan2(place.y, place.x); };
  std::vector<Leds> all;
  for (const Vec3& target : places) {
    for (const double mirror : {1.0, -1.0}) {
      const Vec3 first = {places[0].x, mirror * places[0].y, 0};
      const double turn = azimuth(target) - azimuth(first), c = std::cos(turn), s = std::sin(turn);
      std::vector<std::vector<double>> cost;
      for (const Vec3& place : places) {
        const double y = mirror * place.y;
        const Vec3 moved = {c * place.x - s * y, s * place.x + c * y, 0};
        auto& row = cost.emplace_back();
        for (const Vec3& other : places) row.push_back(dot(moved - other, moved - other));
      }
      Leds leds;
      for (const std::size_t column : least_cost_columns(cost)) leds.push_back(static_cast<int>(column) + 1);
      all.push_back(std::move(leds));
    }
  }
  return all;
}

Leds under(const Leds& leds, const Leds& symmetry) {
  Leds moved;
  for (const int led : leds) moved.push_back(symmetry[static_cast<std::size_t>(led - 1)]);
  return moved;
}

/// Values over their mean over the patches.
void divide_by_mean(std::vector<double>& values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  if (mean > 0)
    for (double& value : values) value /= mean;
}

/// Each row over the mean of all rows, patch by patch, and then over its own mean.
Light shapes_of(Light rows) {
  const auto count = static_cast<double>(rows.size());
  for (std::size_t i = 0; i < rows.front().size(); ++i) {
    double mean = 0;
    for (const auto& row : rows) mean += row[i] / count;
    for (auto& row : rows) row[i] = mean > 0 ? row[i] / mean : 1;
  }
  for (auto& row : rows) divide_by_mean(row);
  return rows;
}

/// The assignment of least cost for a level cloth; nothing where no patch can be read in all frames.
std::optional<Leds> level_start(const Light& light, const PatchLights& model) {
  Light frames(light.size()), lights(model.leds.size());
  for (std::size_t i = 0; i < light.front().size(); ++i) {
    double mean = 0;
    for (const auto& frame : light) mean += frame[i] / static_cast<double>(light.size());
    if (!std::isfinite(mean) || mean <= kLeastMean) continue;
    for (std::size_t f = 0; f < light.size(); ++f) frames[f].push_back(light[f][i]);
    for (std::size_t k = 0; k < lights.size(); ++k) lights[k].push_back(std::max(0.0, model.leds[k][i].z));
  }
  if (frames.front().empty()) return {};
  for (Light* rows : {&frames, &lights})
    for (auto& row : *rows) divide_by_mean(row);
  frames = shapes_of(std::move(frames));
  lights = shapes_of(std::move(lights));
  std::vector<std::vector<double>> cost;
  for (const auto& frame : frames) {
    auto& row = cost.emplace_back();
    for (const auto& led : lights) {
      double off = 0;
      for (std::size_t i = 0; i < frame.size(); ++i) off += std::min(std::abs(frame[i] - led[i]), 1.0);
      row.push_back(off);
    }
  }
  Leds leds;
  for (const std::size_t column : least_cost_columns(cost)) leds.push_back(static_cast<int>(column) + 1);
  return leds;
}

/// Downhill from `leds` until no step leads lower, or it is stopped.
Leds lowest_from(Leds leds, const std::vector<Leds>& symmetries, int count, Misfits& misfits,
                 const std::stop_token& stop) {
  while (true) {
    Leds best = leds;
    const auto look_at = [&](const Leds& other) {
      if (!stop.stop_requested() && misfits.of(other) < misfits.of(best)) best = other;
    };
    for (const Leds& other : neighbours_of(leds, count)) look_at(other);
    for (const Leds& symmetry : symmetries) look_at(under(leds, symmetry));
    if (best == leds) return leds;
    leds = std::move(best);
  }
}

LightAssignment described(const Leds& leds, Misfits& misfits) {
  LightAssignment found = {leds, misfits.of(leds), {}, std::numeric_limits<double>::infinity(), {}};
  std::vector<double> other(leds.size(), std::numeric_limits<double>::infinity());
  for (const auto& [tried, misfit] : misfits.known()) {
    if (tried == leds) continue;
    if (misfit < found.second_misfit) {
      found.second = tried;
      found.second_misfit = misfit;
    }
    for (std::size_t f = 0; f < leds.size(); ++f)
      if (tried[f] != leds[f]) other[f] = std::min(other[f], misfit);
  }
  for (const double misfit : other) found.sure.push_back(times_better(found.misfit, misfit));
  return found;
}

}  // namespace

std::vector<std::size_t> least_cost_columns(const std::vector<std::vector<double>>& cost) {
  if (cost.empty()) return {};
  const std::size_t rows = cost.size(), columns = cost.front().size();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  // Row and column 0 are a helper's; row_of[j] is the row that has column j.
  std::vector<double> of_row(rows + 1), of_column(columns + 1);
  std::vector<std::size_t> row_of(columns + 1), before(columns + 1);
  for (std::size_t row = 1; row <= rows; ++row) {
    row_of[0] = row;
    std::size_t column = 0;
    std::vector<double> least(columns + 1, kInfinite);
    std::vector<bool> is_used(columns + 1);
    do {
      is_used[column] = true;
      const std::size_t at = row_of[column];
      double step = kInfinite;
      std::size_t next = 0;
      for (std::size_t j = 1; j <= columns; ++j) {
        if (is_used[j]) continue;
        const double reduced = cost[at - 1][j - 1] - of_row[at] - of_column[j];
        if (reduced < least[j]) {
          least[j] = reduced;
          before[j] = column;
        }
        if (least[j] < step) {
          step = least[j];
          next = j;
        }
      }
      for (std::size_t j = 0; j <= columns; ++j) {
        if (is_used[j]) {
          of_row[row_of[j]] += step;
          of_column[j] -= step;
        } else {
          least[j] -= step;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    for (; column != 0; column = before[column]) row_of[column] = row_of[before[column]];
  }
  std::vector<std::size_t> found(rows);
  for (std::size_t j = 1; j <= columns; ++j)
    if (row_of[j] != 0) found[row_of[j] - 1] = j - 1;
  return found;
}

bool is_far_better(double misfit, double other) {
  return misfit <= kMostOfOther * other && misfit + kLessThanOther <= other;
}

double times_better(double misfit, double other) {
  return std::max(other, kNoMisfit) / std::max(misfit, kNoMisfit);
}

bool LightAssignment::is_alone() const {
  return second.empty() || is_far_better(misfit, second_misfit);
}

double misfit_under(const std::vector<int>& leds, const std::vector<std::vector<double>>& light,
                    const PatchLights& model) {
  return Misfits(light, model).of(leds);
}

std::optional<LightAssignment> assign_by_light(const std::vector<std::vector<double>>& light,
                                               const PatchLights& model,
                                               const std::vector<std::vector<int>>& starts,
                                               const std::stop_token& stop) {
  if (light.size() < kFewestToAssign || light.size() > model.leds.size()) return {};
  std::optional<Leds> level = level_start(light, model);
  if (!level) return {};
  const std::vector<Leds> symmetries = symmetries_of(model);
  const int count = static_cast<int>(model.leds.size());
  Misfits misfits(light, model);
  Leds best = lowest_from(std::move(*level), symmetries, count, misfits, stop);
  for (const Leds& start : starts) {
    if (misfits.of(start) < misfits.of(best)) best = lowest_from(start, symmetries, count, misfits, stop);
  }
  if (stop.stop_requested()) return {};
  return described(best, misfits);
}

}  // namespace weft::capture
