// SPDX-License-Identifier: Apache-2.0
#include "solve/input/session_conditions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/base/iso_time.h"
#include "core/base/percent.h"
#include "core/image_io/image_io.h"
#include "solve/conditions/brackets.h"
#include "solve/conditions/drift.h"
#include "solve/conditions/photosites.h"
#include "solve/conditions/useless_lights.h"

namespace weft::app {
namespace {

using pipeline::Drift;
using pipeline::Mosaics;
using pipeline::UselessLight;

Result<std::vector<Photosite>> photosites_named_by(const std::filesystem::path& hot_picture, Size size) {
  const Result<LoadedImage> image = read_image(hot_picture);
  if (!image) return image.error();
  const Size found = image->planes.size();
  if (found != size) {
    return Error{ErrorKind::kBadData, "hot.png differs in size from the frames", hot_picture.string(),
                 fmt::format("it has {} x {} pixels, the frames {} x {}", found.width, found.height,
                             size.width, size.height),
                 "name the calibration of this camera with --calibration"};
  }
  std::vector<Photosite> named;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (image->planes(x, y) > 0) named.push_back({y, x});
    }
  }
  return named;
}

const Shot& lit_shot_of(const SessionPlan& plan, int led) {
  return *std::find_if(plan.lit.begin(), plan.lit.end(), [&](const Shot& s) { return s.led == led; });
}

// The place of a LED among those that are solved from; their number where it is not among them.
std::size_t light_of(const pipeline::Photographs& photographs, int led) {
  const std::vector<int>& leds = photographs.leds;
  return static_cast<std::size_t>(std::find(leds.begin(), leds.end(), led) - leds.begin());
}

// When each shot was taken, by its time where all have one, else by its place in the order of capture.
class Clock {
 public:
  explicit Clock(const SessionPlan& plan) {
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
pipeline::DriftEvidence drift_evidence(const SessionPlan& plan, const pipeline::Photographs& photographs,
                                       pipeline::Frames again) {
  const Clock time_of(plan);
  pipeline::DriftEvidence evidence;
  evidence.patches = plan.calibration.patches;
  evidence.again = std::move(again);
  for (std::size_t i = 0; i < plan.repeats.size(); ++i) {
    const Shot& shot = plan.repeats[i];
    const std::size_t light = light_of(photographs, shot.led);
    if (light == photographs.count()) continue;
    evidence.repeats.push_back({light, i, time_of(lit_shot_of(plan, shot.led)), time_of(shot)});
  }
  for (const int led : photographs.leds) evidence.times.push_back(time_of(lit_shot_of(plan, led)));
  evidence.first_time = std::numeric_limits<double>::infinity();
  for (const Shot& shot : plan.lit) evidence.first_time = std::min(evidence.first_time, time_of(shot));
  return evidence;
}

// Of one patch.
std::string words_of(std::span<const pipeline::PatchDeparture> departures, const std::vector<int>& leds) {
  std::vector<int> of_leds;
  double worst = 1;
  for (const pipeline::PatchDeparture& each : departures) {
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
std::vector<std::string> words_of(const Drift& drift, const pipeline::DriftEvidence& evidence,
                                  const SessionPlan& plan, const std::vector<int>& leds) {
  std::vector<std::string> words;
  if (drift.unread_light) {
    words.push_back(
        fmt::format("no white patch can be read in the light of LED {}, as they lie outside the frame, are "
                    "saturated or unlit; patches were not used",
                    leds[*drift.unread_light]));
  }
  for (auto first = drift.departures.begin(); first != drift.departures.end();) {
    const auto last = std::find_if(first, drift.departures.end(),
                                   [&](const auto& each) { return each.patch != first->patch; });
    words.push_back(words_of({first, last}, leds));
    first = last;
  }
  for (std::size_t i = 0; i < drift.ratios.size(); ++i) {
    const std::optional<double>& ratio = drift.ratios[i];
    if (ratio && pipeline::is_drift(*ratio)) continue;
    const Shot& again = plan.repeats[evidence.repeats[i].frame];
    words.push_back(
        fmt::format("LED {} gave {} of its light when {} repeated it: too far off to be drift, so it was not "
                    "used; see whether the LED was covered or failed",
                    again.led, ratio ? fmt::format("{:.3g} times", *ratio) : "none", again.file));
  }
  for (std::size_t k = 0; k < drift.measured.size(); ++k) {
    if (pipeline::is_drift(drift.measured[k])) continue;
    words.push_back(
        fmt::format("LED {} gave {:.3g} times the light of its calibration: too far off to be drift, so it "
                    "was not corrected; see whether the LED was covered or replaced",
                    leds[k], drift.measured[k]));
  }
  return words;
}

// Of all lights that are useless for one reason; empty where none is.
std::string words_of(const std::vector<UselessLight>& useless, UselessLight::Why why,
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

ConditionFacts facts_of(const SessionConditions& conditions) {
  ConditionFacts facts;
  if (conditions.replaced_photosites)
    facts.hot_photosites = static_cast<int>(*conditions.replaced_photosites);
  facts.veil = conditions.veil;
  facts.brackets = static_cast<int>(conditions.brackets);
  for (const LeftOutLed& left_out : conditions.left_out) {
    const bool is_saturated = left_out.why == UselessLight::Why::kSaturated;
    facts.left_out.push_back({left_out.led, is_saturated ? "saturated" : "not lit"});
  }
  for (const LedDrift& drift : conditions.drift) {
    const bool by_patches = conditions.drift_source == Drift::Source::kPatches;
    facts.drift.push_back({drift.led, drift.factor, by_patches ? "patches" : "repeat"});
  }
  if (!conditions.cloth_gains) return facts;
  const pipeline::LedGains& told = *conditions.cloth_gains;
  facts.cloth_gains = {{}, told.misfit_before, told.misfit_after, told.left_out->mean, told.left_out->sigma};
  for (std::size_t k = 0; k < conditions.leds.size(); ++k)
    facts.cloth_gains->leds.push_back({conditions.leds[k], told.gain[k], told.sigma[k]});
  return facts;
}

Result<void> replace_bad_photosites(const SessionPlan& plan, const JobContext& context, LoadedSession& loaded,
                                    MoreFrames& more) {
  Mosaics* mosaics = loaded.photographs.mosaics();
  if (mosaics == nullptr) return {};
  std::vector<Photosite> known;
  if (plan.calibration.hot_picture) {
    auto named = photosites_named_by(*plan.calibration.hot_picture, plan.size);
    if (!named) return std::move(named).error();
    known = std::move(*named);
  }
  std::vector<RawFrame*> others;
  for (pipeline::Frames* each : {&more.repeats, &more.parallel}) {
    for (RawFrame& frame : std::get<Mosaics>(*each).frames) others.push_back(&frame);
  }
  for (RawFrame& frame : more.brackets) others.push_back(&frame);
  pipeline::replace_bad_photosites(pipeline::find_bad_photosites(*mosaics, known, context.threads), *mosaics,
                                   others, context.threads);
  loaded.conditions.replaced_photosites = mosaics->replaced.size();
  return {};
}

void join_brackets(const SessionPlan& plan, LoadedSession& loaded, MoreFrames& more) {
  std::vector<pipeline::BracketShot> shots;
  for (std::size_t i = 0; i < more.brackets.size(); ++i) {
    const Shot& shot = plan.brackets[i];
    const double exposure_us = plan.lit.front().exposure_us;
    shots.push_back({light_of(loaded.photographs, shot.led),
                     plan.calibration.response->exposure_ratio(shot.exposure_us, exposure_us).value(),
                     std::move(more.brackets[i])});
  }
  loaded.conditions.brackets = shots.size();
  if (Mosaics* mosaics = loaded.photographs.mosaics()) pipeline::join_brackets(std::move(shots), *mosaics);
}

Result<void> leave_out_useless_lights(const SessionPlan& plan, LoadedSession& loaded) {
  pipeline::Photographs& photographs = loaded.photographs;
  const std::vector<UselessLight> useless = pipeline::find_useless_lights(photographs);
  std::vector<std::size_t> lights;
  for (const UselessLight& light : useless) {
    lights.push_back(light.light);
    loaded.conditions.left_out.push_back({photographs.leds[light.light], light.why});
  }
  std::vector<std::string> warnings;
  std::string reasons;
  for (const auto why : {UselessLight::Why::kSaturated, UselessLight::Why::kNotLit}) {
    const std::string words = words_of(useless, why, photographs.leds);
    if (words.empty()) continue;
    reasons += (reasons.empty() ? "" : "; ") + words;
    const auto count = std::ranges::count(useless, why, &UselessLight::why);
    warnings.push_back(words + (count == 1 ? "; it was left out" : "; they were left out"));
  }
  const std::size_t rest = photographs.count() - useless.size();
  if (!useless.empty() && rest < 3) {
    return Error{ErrorKind::kBadData, "too few lights", plan.session.folder.string(),
                 fmt::format("{}, which leaves {}; a normal and an albedo are three unknowns", reasons, rest),
                 "see to these LEDs and to the exposure, and scan the cloth again"};
  }
  loaded.warnings.insert(loaded.warnings.begin(), warnings.begin(), warnings.end());
  return pipeline::leave_out(lights, photographs);
}

Result<void> follow_drift(const SessionPlan& plan, const JobContext& context, LoadedSession& loaded,
                          MoreFrames& more) {
  pipeline::Photographs& photographs = loaded.photographs;
  const pipeline::DriftEvidence evidence = drift_evidence(plan, photographs, std::move(more.repeats));
  const Drift drift = pipeline::find_drift(photographs, evidence, context.threads);
  const std::vector<std::string> words = words_of(drift, evidence, plan, photographs.leds);
  loaded.warnings.insert(loaded.warnings.end(), words.begin(), words.end());
  loaded.conditions.drift_source = drift.source;
  for (std::size_t k = 0; k < drift.measured.size(); ++k) {
    loaded.conditions.drift.push_back({photographs.leds[k], drift.factor(k)});
  }
  return pipeline::follow(drift, photographs);
}

Result<void> follow_cloth(const JobContext& context, LoadedSession& loaded) {
  if (loaded.conditions.drift_source == Drift::Source::kPatches) return {};
  pipeline::Photographs& photographs = loaded.photographs;
  Result<std::optional<pipeline::LedGains>> found = pipeline::find_led_gains(photographs, {}, context);
  if (!found) return std::move(found).error();
  if (!*found || !(*found)->is_kept()) return {};
  Result<LightField> field =
      LightField::make(brightened(photographs.field->lights(), (*found)->gain), photographs.camera,
                       photographs.size, photographs.field->cloth_height_mm());
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  loaded.conditions.cloth_gains = std::move(**found);
  loaded.conditions.leds = photographs.leds;
  return {};
}

}  // namespace weft::app
