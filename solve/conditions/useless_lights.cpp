// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/useless_lights.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "core/base/percent.h"

namespace weft::solve {
namespace {

constexpr double kMostOfFrame = 0.99;
constexpr double kLeastLight = 0.01;
constexpr double kOutOfTheDark_sigmas = 5;
constexpr int kStatisticsRows = 16;  // from one filter cell that is looked at to the next

// What a photograph looks like as a whole.
struct FrameStatistics {
  double full_share = 0;
  double mean = 0;       // of the readings that are finite
  double predicted = 0;  // of a white cloth that lies flat, by the field
  double doubt = 0;      // standard error of the mean of a dark frame
};

FrameStatistics statistics_of(const Photographs& photographs, std::size_t k) {
  const Size size = photographs.size;
  Image<float> scratch({size.width, 2});
  std::int64_t full = 0, finite = 0, all = 0;
  double sum = 0, predicted = 0;
  for (int y = 0; y < size.height; y += kStatisticsRows) {
    const Rect rows = {0, y, size.width, std::min(y + 2, size.height)};
    for (const View<const float>& plane : readings_of(photographs.frames, k, rows, scratch.plane())) {
      for (int j = 0; j < plane.height(); ++j) {
        for (int x = 0; x < plane.width(); ++x) {
          const float r = plane(x, j);
          ++all;
          full += r == std::numeric_limits<float>::infinity();
          if (!std::isfinite(r)) continue;
          ++finite;
          sum += static_cast<double>(r);
        }
      }
    }
    const LightField::Light light = photographs.field->at(k, 1, size.width / 2, y);
    predicted += light.strength * std::max(light.direction.z, 0.0);
  }
  const int looks = (size.height + kStatisticsRows - 1) / kStatisticsRows;
  const auto share_of = [](double value, std::int64_t count) {
    return value / static_cast<double>(std::max<std::int64_t>(count, 1));
  };
  const std::optional<NoiseModel> noise = photographs.noise();
  const double floor = noise ? noise->floor + noise->shared : 0;
  return {share_of(static_cast<double>(full), all), share_of(sum, finite), predicted / looks,
          std::sqrt(share_of(floor, finite))};
}

// Names all lights that are useless for one reason; empty where none is.
std::string useless_words(const std::vector<UselessLight>& useless, UselessLight::Why why,
                          const std::vector<int>& leds) {
  std::vector<int> of_leds;
  double least = 1;
  for (const UselessLight& light : useless) {
    if (light.why != why) continue;
    of_leds.push_back(leds[light.light]);
    least = std::min(least, light.full_share);
  }
  if (of_leds.empty()) return "";
  const bool is_one = of_leds.size() == 1;
  const std::string names = fmt::format("LED{} {}", is_one ? "" : "s", fmt::join(of_leds, ", "));
  if (why == UselessLight::Why::kNotLit) {
    return fmt::format("{} did not light the cloth: {} like the dark shot", names,
                       is_one ? "its frame looks" : "their frames look");
  }
  return fmt::format("{} saturated {}{} percent of the frame", names, is_one ? "" : "at least ",
                     percent_words(least));
}

}  // namespace

std::vector<UselessLight> find_useless_lights(const Photographs& photographs) {
  std::vector<FrameStatistics> statistics;
  double best = 0;  // 0 where no frame stands out of the noise: then none looks darker than the others
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    const FrameStatistics& s = statistics.emplace_back(statistics_of(photographs, k));
    if (s.predicted > 0 && s.mean > kOutOfTheDark_sigmas * s.doubt)
      best = std::max(best, s.mean / s.predicted);
  }
  std::vector<UselessLight> useless;
  for (std::size_t k = 0; k < statistics.size(); ++k) {
    const FrameStatistics& s = statistics[k];
    if (s.full_share > kMostOfFrame) {
      useless.push_back({k, UselessLight::Why::kSaturated, s.full_share});
    } else if (s.predicted > 0 && best > 0 && s.mean <= kLeastLight * best * s.predicted) {
      useless.push_back({k, UselessLight::Why::kNotLit, s.full_share});
    }
  }
  return useless;
}

Result<void> drop_useless_lights(const Exposures& exposures) {
  if (!exposures.plan.is_of_rig) return {};
  Photographs& photographs = exposures.photographs;
  Conditions& conditions = photographs.conditions;
  const std::vector<UselessLight> useless = find_useless_lights(photographs);
  std::vector<std::size_t> lights;
  for (const UselessLight& light : useless) {
    const bool is_saturated = light.why == UselessLight::Why::kSaturated;
    lights.push_back(light.light);
    conditions.facts.left_out.push_back(
        {photographs.leds[light.light], is_saturated ? "saturated" : "not lit"});
  }
  std::vector<std::string> warnings;
  std::string reasons;
  for (const auto why : {UselessLight::Why::kSaturated, UselessLight::Why::kNotLit}) {
    const std::string words = useless_words(useless, why, photographs.leds);
    if (words.empty()) continue;
    reasons += (reasons.empty() ? "" : "; ") + words;
    const auto count = std::ranges::count(useless, why, &UselessLight::why);
    warnings.push_back(words + (count == 1 ? "; it was left out" : "; they were left out"));
  }
  const std::size_t rest = photographs.count() - useless.size();
  if (!useless.empty() && rest < 3) {
    return Error{ErrorKind::kBadData, "too few lights", exposures.plan.where,
                 fmt::format("{}, which leaves {}; a normal and an albedo are three unknowns", reasons, rest),
                 "see to these LEDs and to the exposure, and scan the cloth again"};
  }
  conditions.warnings.insert(conditions.warnings.begin(), warnings.begin(), warnings.end());
  return leave_out(lights, photographs);
}

}  // namespace weft::solve
