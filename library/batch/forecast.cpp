// SPDX-License-Identifier: Apache-2.0
#include "library/batch/forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace weft::library {
namespace {

constexpr std::size_t kClasses = 4;  // from the narrowest

// The class of a session, by how narrow it is.
std::string class_of(const SessionTraits& t, std::size_t width) {
  const std::string size = fmt::format("{:.3f}", t.megapixels);
  switch (width) {
    case 0:
      return fmt::format("{}\n{}\n{}\n{}", t.fabric, t.calibration, size, t.frames);
    case 1:
      return fmt::format("{}\n{}", t.fabric, size);
    case 2:
      return size;
    default:
      return "";
  }
}

double work_of(const SessionTraits& t) {
  return std::max(t.megapixels, 1e-6) * std::max(t.frames, 1);
}

// Mean and standard deviation of numbers that come one by one.
class Moments {
 public:
  void add(double value) {
    ++count_;
    const double off = value - mean_;
    mean_ += off / count_;
    squares_ += off * (value - mean_);
  }
  int count() const { return count_; }
  double mean() const { return mean_; }
  double deviation() const { return count_ > 1 ? std::sqrt(squares_ / (count_ - 1)) : 0; }

 private:
  int count_ = 0;
  double mean_ = 0, squares_ = 0;
};

// One level of the sessions of one class: seconds are a megapixel and frame.
struct Known {
  Moments seconds, solve_seconds, degrees, solved;
};

using KnownLevels = std::vector<Known>;
using Classes = std::array<std::unordered_map<std::string, KnownLevels>, kClasses>;
using Turns = std::unordered_map<std::string, std::vector<Moments>>;

// Sessions that were solved alike so far, of one cloth; without a cloth the wider class.
std::string turn_class(const SessionTraits& t, bool of_cloth) {
  return fmt::format("{}\n{}\n{}", t.before, t.calibration, of_cloth ? t.fabric : "");
}

void learn(std::span<const SessionTraits> sessions, std::span<const MeasuredSession> measured,
           Classes& classes, Turns& turns) {
  for (const MeasuredSession& each : measured) {
    const SessionTraits& traits = sessions[each.session];
    for (std::size_t width = 0; width < kClasses; ++width) {
      KnownLevels& known = classes[width][class_of(traits, width)];
      known.resize(each.levels.size());
      for (std::size_t l = 0; l < known.size(); ++l) {
        known[l].seconds.add(each.levels[l].seconds / work_of(traits));
        known[l].solve_seconds.add(each.levels[l].solve_seconds / work_of(traits));
        known[l].degrees.add(each.levels[l].degrees);
        known[l].solved.add(each.levels[l].solved);
      }
    }
    for (const bool of_cloth : {true, false}) {
      std::vector<Moments>& known = turns[turn_class(traits, of_cloth)];
      known.resize(each.levels.size());
      for (std::size_t l = 0; l < known.size(); ++l) {
        if (each.levels[l].turn_deg) known[l].add(*each.levels[l].turn_deg);
      }
    }
  }
}

std::vector<const KnownLevels*> known_of(const SessionTraits& traits, const Classes& classes) {
  std::vector<const KnownLevels*> known;
  for (std::size_t width = 0; width < kClasses; ++width) {
    const auto found = classes[width].find(class_of(traits, width));
    if (found != classes[width].end()) known.push_back(&found->second);
  }
  return known;
}

std::optional<double> turn_of(const SessionTraits& traits, std::size_t level, const Turns& turns) {
  if (traits.before.empty()) return {};
  for (const bool of_cloth : {true, false}) {
    const auto found = turns.find(turn_class(traits, of_cloth));
    if (found == turns.end() || found->second[level].count() == 0) continue;
    // What may well be more is not called little.
    return found->second[level].mean() + found->second[level].deviation();
  }
  return {};
}

std::vector<Forecast> forecast_of(const SessionTraits& traits, const Classes& classes, const Turns& turns) {
  const std::vector<const KnownLevels*> known = known_of(traits, classes);
  std::vector<Forecast> levels(known.front()->size());
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const Known& narrowest = (*known.front())[l];
    levels[l].seconds = narrowest.seconds.mean() * work_of(traits);
    levels[l].solve_seconds = narrowest.solve_seconds.mean() * work_of(traits);
    levels[l].degrees = narrowest.degrees.mean();
    levels[l].solved = narrowest.solved.mean();
    for (const KnownLevels* each : known) {
      if ((*each)[l].seconds.count() < 2) continue;
      levels[l].seconds_spread = (*each)[l].seconds.deviation() * work_of(traits);
      levels[l].degrees_spread = (*each)[l].degrees.deviation();
      break;
    }
    levels[l].turn_deg = turn_of(traits, l, turns);
  }
  return levels;
}

}  // namespace

std::vector<std::size_t> choose_sample(std::span<const SessionTraits> sessions, std::size_t most) {
  std::map<std::string, std::vector<std::size_t>> by_class;
  for (std::size_t i = 0; i < sessions.size(); ++i)
    by_class[class_of(sessions[i], 0) + "\n" + sessions[i].before].push_back(i);
  std::vector<const std::vector<std::size_t>*> classes;
  for (const auto& [name, members] : by_class) classes.push_back(&members);
  std::ranges::stable_sort(classes, [](const auto* a, const auto* b) { return a->size() > b->size(); });
  std::vector<std::size_t> wanted(classes.size(), 0);
  std::size_t left = std::min(most, sessions.size());
  while (left > 0) {
    for (std::size_t c = 0; c < classes.size() && left > 0; ++c) {
      if (wanted[c] == classes[c]->size()) continue;
      ++wanted[c], --left;
    }
  }
  std::vector<std::size_t> sample;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    for (std::size_t k = 0; k < wanted[c]; ++k)
      sample.push_back((*classes[c])[(2 * k + 1) * classes[c]->size() / (2 * wanted[c])]);
  }
  std::ranges::sort(sample);
  return sample;
}

std::vector<std::vector<Forecast>> carry_over(std::span<const SessionTraits> sessions,
                                              std::span<const MeasuredSession> measured) {
  if (measured.empty()) return {};
  Classes classes;
  Turns turns;
  learn(sessions, measured, classes, turns);
  std::vector<std::vector<Forecast>> forecasts;
  forecasts.reserve(sessions.size());
  for (const SessionTraits& traits : sessions) forecasts.push_back(forecast_of(traits, classes, turns));
  for (const MeasuredSession& each : measured) {
    forecasts[each.session] = each.levels;
    for (Forecast& level : forecasts[each.session]) level.is_measured = true;
  }
  return forecasts;
}

}  // namespace weft::library
