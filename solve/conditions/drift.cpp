// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/drift.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "core/base/iso_time.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"

namespace weft::solve {
namespace {

// As solve.json has them.
constexpr const char *kFromPatches = "patches", *kFromRepeats = "repeat";

// Light of a repeat over that of the photograph of the same light.
std::optional<double> ratio_of(const RepeatedLight& repeat, const Photographs& photographs,
                               const Frames& again, int threads) {
  const Size size = photographs.size;
  constexpr int kBlock = solver::kLightBlock;
  const int across = (size.width + kBlock - 1) / kBlock;
  const auto down = static_cast<std::size_t>((size.height + kBlock - 1) / kBlock);
  std::vector<solver::BlockChange> blocks(down * static_cast<std::size_t>(across));
  std::vector<Image<float>> scratch;
  for (int i = 0; i < resolved_threads(threads); ++i) scratch.emplace_back(Size{kBlock, kBlock}, 2);
  parallel_for(down, threads, [&](std::size_t j, int worker) {
    Image<float>& mine = scratch[static_cast<std::size_t>(worker)];
    for (int i = 0; i < across; ++i) {
      const Rect block = {i * kBlock, static_cast<int>(j) * kBlock, std::min((i + 1) * kBlock, size.width),
                          std::min((static_cast<int>(j) + 1) * kBlock, size.height)};
      blocks[j * static_cast<std::size_t>(across) + static_cast<std::size_t>(i)] =
          solver::block_light(readings_of(photographs.frames, repeat.light, block, mine.plane(0)),
                              readings_of(again, repeat.frame, block, mine.plane(1)));
    }
  });
  return solver::light_ratio(std::move(blocks));
}

void ask_repeats(const Photographs& photographs, const DriftEvidence& evidence, int threads, Drift& drift) {
  std::vector<solver::LightRepeat> used;
  for (const RepeatedLight& repeat : evidence.repeats) {
    const auto ratio = drift.ratios.emplace_back(ratio_of(repeat, photographs, evidence.again, threads));
    if (ratio && is_drift(*ratio)) used.push_back({repeat.earlier_time, repeat.later_time, *ratio});
  }
  if (used.empty()) return;
  drift.source = Drift::Source::kRepeats;
  const double rate = solver::drift_rate(used);
  for (const double time : evidence.times) drift.measured.push_back(1 + rate * (time - evidence.first_time));
}

// Fields by the height of patches; the photographs' own where a patch has none.
class PatchFields {
 public:
  explicit PatchFields(const Photographs& photographs) : photographs_(photographs) {}

  /// Nothing where no light can be at this height.
  const LightField* at(std::optional<double> height_mm) {
    if (!height_mm) return &*photographs_.field;
    const auto [at, is_new] = fields_.try_emplace(*height_mm);
    if (is_new) {
      Result<LightField> field =
          LightField::make(photographs_.field->lights(), photographs_.camera, photographs_.size, *height_mm);
      if (field) at->second = std::move(*field);
    }
    return at->second ? &*at->second : nullptr;
  }

 private:
  const Photographs& photographs_;
  std::map<double, std::optional<LightField>> fields_;
};

// Patches that contradict the others under most lights.
std::size_t misplaced_among(const std::vector<PatchDeparture>& departures, std::size_t lights) {
  std::map<std::size_t, std::size_t> counts;
  for (const PatchDeparture& each : departures) {
    if (std::abs(each.ratio - 1) > kMisplaced) ++counts[each.patch];
  }
  return static_cast<std::size_t>(
      std::ranges::count_if(counts, [&](const auto& each) { return 2 * each.second > lights; }));
}

void ask_patches(const Photographs& photographs, const std::vector<WhitePatch>& patches, Drift& drift) {
  if (patches.empty()) return;
  PatchFields fields(photographs);
  std::vector<std::vector<std::optional<solver::PatchLight>>> seen;
  for (const WhitePatch& patch : patches) {
    const LightField* field = fields.at(patch.height_mm);
    if (field == nullptr) {
      seen.emplace_back(photographs.count());
    } else {
      seen.push_back(read_patch(photographs, patch, *field));
    }
  }
  std::vector<double> factors;
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    std::vector<double> of_patches;
    for (const auto& patch : seen) {
      if (patch[k]) of_patches.push_back(patch[k]->factor());
    }
    if (of_patches.empty()) {
      drift.unread_light = k;
      return;
    }
    factors.push_back(median(std::move(of_patches)));
  }
  for (std::size_t p = 0; p < seen.size(); ++p) {
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const double ratio = seen[p][k] ? seen[p][k]->factor() / factors[k] : 1;
      if (std::abs(ratio - 1) > kMostScatter) drift.departures.push_back({p, k, ratio});
    }
  }
  if (const std::size_t count = misplaced_among(drift.departures, factors.size());
      seen.size() >= 4 && 2 * count >= seen.size()) {
    drift.misplaced = count;
    drift.departures.clear();
    return;
  }
  drift.source = Drift::Source::kPatches;
  drift.measured = std::move(factors);
}

const Shot& lit_shot_of(const SolvePlan& plan, int led) {
  return *std::find_if(plan.lit.begin(), plan.lit.end(), [&](const Shot& s) { return s.led == led; });
}

// When each shot was taken, by its time where all have one, else by its place in the order of capture.
class ShotClock {
 public:
  explicit ShotClock(const SolvePlan& plan) {
    for (const auto* shots : {&plan.lit, &plan.repeats}) {
      for (const Shot& shot : *shots)
        all_have_time_ = all_have_time_ && seconds_of_iso_time(shot.time).has_value();
    }
  }
  double operator()(const Shot& shot) const {
    return all_have_time_ ? *seconds_of_iso_time(shot.time) : shot.index;
  }

 private:
  bool all_have_time_ = true;
};

// What a session says of the brightness of its LEDs. Repeats of LEDs that were left out say nothing.
DriftEvidence drift_evidence(const SolvePlan& plan, const Photographs& photographs, Frames again) {
  const ShotClock time_of(plan);
  DriftEvidence evidence;
  evidence.patches = plan.calibration.patches;
  evidence.again = std::move(again);
  for (std::size_t i = 0; i < plan.repeats.size(); ++i) {
    const Shot& shot = plan.repeats[i];
    const std::size_t light = photographs.light_of(shot.led);
    if (light == photographs.count()) continue;
    evidence.repeats.push_back({light, i, time_of(lit_shot_of(plan, shot.led)), time_of(shot)});
  }
  for (const int led : photographs.leds) evidence.times.push_back(time_of(lit_shot_of(plan, led)));
  evidence.first_time = std::numeric_limits<double>::infinity();
  for (const Shot& shot : plan.lit) evidence.first_time = std::min(evidence.first_time, time_of(shot));
  return evidence;
}

// What one patch says that others do not.
std::string departure_words(std::span<const PatchDeparture> departures, const std::vector<int>& leds) {
  std::vector<int> of_leds;
  double worst = 1;
  for (const PatchDeparture& each : departures) {
    of_leds.push_back(leds[each.light]);
    if (std::abs(each.ratio - 1) > std::abs(worst - 1)) worst = each.ratio;
  }
  return fmt::format(
      "white patch {} gives {:.3g} times the light that most patches give{}, and their median was used; see "
      "whether cloth or its shadow lies on it, or whether it is dirty",
      departures.front().patch + 1, worst,
      of_leds.size() == leds.size()
          ? ""
          : fmt::format(" under LED{} {}", of_leds.size() == 1 ? "" : "s", fmt::join(of_leds, ", ")));
}

// What there is to be warned of, in sentences.
std::vector<std::string> drift_words(const Drift& drift, const DriftEvidence& evidence, const SolvePlan& plan,
                                     const std::vector<int>& leds) {
  std::vector<std::string> words;
  if (drift.unread_light) {
    words.push_back(
        fmt::format("no white patch can be read in the light of LED {}, as they lie outside the frame, are "
                    "saturated or unlit; patches were not used",
                    leds[*drift.unread_light]));
  }
  if (drift.misplaced) {
    words.push_back(
        fmt::format("{} of {} white patches contradict the others: they are not where the calibration has "
                    "them, and were not used; see whether the rig moved (weft rig check)",
                    *drift.misplaced, evidence.patches.size()));
  }
  for (auto first = drift.departures.begin(); first != drift.departures.end();) {
    const auto last = std::find_if(first, drift.departures.end(),
                                   [&](const auto& each) { return each.patch != first->patch; });
    words.push_back(departure_words({first, last}, leds));
    first = last;
  }
  for (std::size_t i = 0; i < drift.ratios.size(); ++i) {
    const std::optional<double>& ratio = drift.ratios[i];
    if (ratio && is_drift(*ratio)) continue;
    const Shot& again = plan.repeats[evidence.repeats[i].frame];
    words.push_back(
        fmt::format("LED {} gave {} of its light when {} repeated it: too far off to be drift, so it was not "
                    "used; see whether the LED was covered or failed",
                    again.led, ratio ? fmt::format("{:.3g} times", *ratio) : "none", again.file));
  }
  for (std::size_t k = 0; k < drift.measured.size(); ++k) {
    if (is_drift(drift.measured[k])) continue;
    words.push_back(
        fmt::format("LED {} gave {:.3g} times the light of its calibration: too far off to be drift, so it "
                    "was not corrected; see whether the LED was covered or replaced",
                    leds[k], drift.measured[k]));
  }
  return words;
}

}  // namespace

bool is_drift(double factor) {
  return std::abs(factor - 1) <= kMostDrift;
}

double Drift::factor(std::size_t k) const {
  return is_drift(measured[k]) ? measured[k] : 1;
}

std::vector<std::optional<solver::PatchLight>> read_patch(const Photographs& photographs,
                                                          const WhitePatch& patch, const LightField& field) {
  std::vector<std::optional<solver::PatchLight>> lights(photographs.count());
  const WhitePatch inside = solver::well_inside(patch);
  const Rect area = solver::area_of(inside, photographs.size);
  if (area.pixels() == 0) return lights;
  Image<float> scratch({area.width(), area.height()});
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const solver::PatchLight light =
        solver::patch_light(inside, field, k, area, readings_of(photographs.frames, k, area, scratch.plane()),
                            photographs.planes().cfa);
    const auto& [r, g, b] = light.predicted_rgb;
    if (light.unusable <= light.used && r + g + b > 0) lights[k] = light;
  }
  return lights;
}

Drift find_drift(const Photographs& photographs, const DriftEvidence& evidence, int threads) {
  Drift drift;
  ask_patches(photographs, evidence.patches, drift);
  if (drift.source == Drift::Source::kNone) ask_repeats(photographs, evidence, threads, drift);
  return drift;
}

Result<void> follow(const Drift& drift, Photographs& photographs) {
  if (drift.source == Drift::Source::kNone) return {};
  std::vector<double> factors;
  for (std::size_t k = 0; k < drift.measured.size(); ++k) factors.push_back(drift.factor(k));
  Result<LightField> field =
      LightField::make(brightened(photographs.field->lights(), factors), photographs.camera, photographs.size,
                       photographs.field->cloth_height_mm());
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  return {};
}

Result<void> follow_drift(const Exposures& exposures) {
  Photographs& photographs = exposures.photographs;
  const DriftEvidence evidence =
      drift_evidence(exposures.plan, photographs, std::move(exposures.beside.repeats));
  const Drift drift = find_drift(photographs, evidence, exposures.context.threads);
  Conditions& conditions = photographs.conditions;
  for (std::string& said : drift_words(drift, evidence, exposures.plan, photographs.leds))
    conditions.warnings.push_back(std::move(said));
  const char* from = drift.source == Drift::Source::kPatches ? kFromPatches : kFromRepeats;
  for (std::size_t k = 0; k < drift.measured.size(); ++k)
    conditions.facts.drift.push_back({photographs.leds[k], drift.factor(k), from});
  return follow(drift, photographs);
}

bool was_told_by_patches(const ConditionFacts& facts) {
  return !facts.drift.empty() && facts.drift.front().from == kFromPatches;
}

}  // namespace weft::solve
