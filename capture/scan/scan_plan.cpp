// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/scan_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/rig/exposure_words.h"

namespace weft::capture {
namespace {

constexpr double kSameTime = 0.01;  // 1/60 s is listed as 16667 or 16700 us; a third of a stop is 0.26
const double kHalfAStep = std::exp2(1.0 / 6);

}  // namespace

int ShotList::count() const {
  const int lit = static_cast<int>(leds.size());
  const int states = std::max(1, static_cast<int>(polariser.size()));
  return 1 + states * lit + (repeat ? 2 : 0) + (bracket ? lit : 0) + (below ? 1 : 0) + (blade ? 1 : 0);
}

ShotList asked_shots(const ScanRequest& request) {
  return {request.leds,  request.repeat, request.bracket, request.polariser.states,
          request.below, request.blade};
}

Json to_json(const ShotList& list) {
  Json json = {{"leds", list.leds}, {"repeat", list.repeat}};
  if (list.bracket) json["bracket"] = *list.bracket;
  for (const Polariser state : list.polariser) json["polariser"].push_back(name_of(state));
  if (list.below) json["below"] = true;
  if (list.blade) json["blade"] = *list.blade;
  return json;
}

std::vector<DueShot> plan_shots(const ShotList& list, const ExposureSettings& exposure,
                                const OtherTimes& times) {
  std::vector<DueShot> plan;
  const Polariser solved = list.polariser.empty() ? Polariser::kNone : list.polariser.front();
  const auto add = [&](int led, ShotRole role, double exposure_us, std::optional<Polariser> other = {}) {
    plan.push_back({static_cast<int>(plan.size()),
                    led,
                    role,
                    {exposure_us, exposure.iso, exposure.f_number},
                    other.value_or(solved)});
  };
  add(0, ShotRole::kDark, exposure.exposure_us);
  for (const int led : list.leds) add(led, ShotRole::kLit, exposure.exposure_us);
  if (list.repeat) add(list.leds.front(), ShotRole::kRepeat, exposure.exposure_us);
  if (list.bracket) {
    for (const int led : list.leds) add(led, ShotRole::kBracket, times.bracket_us);
  }
  for (std::size_t i = 1; i < list.polariser.size(); ++i) {
    for (const int led : list.leds) add(led, ShotRole::kLit, exposure.exposure_us, list.polariser[i]);
  }
  if (list.below) add(0, ShotRole::kBelow, times.below_us);
  if (list.repeat) add(0, ShotRole::kRepeat, exposure.exposure_us);
  if (list.blade) add(*list.blade, ShotRole::kBlade, exposure.exposure_us);
  return plan;
}

std::vector<DueShot> plan_of(const Session& session, const ExposureSettings& exposure,
                             const OtherTimes& times) {
  std::vector<DueShot> plan;
  for (const Shot& shot : session.shots) {
    const double time_us = shot.role == ShotRole::kBracket ? times.bracket_us
                           : shot.role == ShotRole::kBelow ? times.below_us
                                                           : exposure.exposure_us;
    plan.push_back(
        {shot.index, shot.led, shot.role, {time_us, exposure.iso, exposure.f_number}, shot.polariser});
  }
  return plan;
}

Result<DueShot> shot_again(const Session& session, int index, const ExposureSettings& exposure,
                           std::optional<double> bracket_us) {
  const auto refuse = [&](std::string why, std::string remedy) {
    return Error{ErrorKind::kUsage, "the shot cannot be taken again",
                 fmt::format("{}: index {}", session.folder.string(), index), std::move(why),
                 std::move(remedy)};
  };
  const auto old = std::ranges::find(session.shots, index, &Shot::index);
  if (old == session.shots.end()) return refuse("there is no such shot", "name one of the session's");
  if (old->superseded_by) {
    return refuse(fmt::format("shot {} stands for it already", *old->superseded_by), "take that one again");
  }
  const bool is_lit = old->role == ShotRole::kLit;
  if (!is_lit && (old->role != ShotRole::kDark || bracket_us)) {
    return refuse("it is a " + std::string(weft::name_of(old->role)) + " shot",
                  "take a lit shot again, or the dark one at its exposure");
  }
  int last = 0;
  for (const Shot& shot : session.shots) last = std::max(last, shot.index);
  DueShot again = {last + 1, old->led, old->role, exposure, old->polariser};
  if (bracket_us) {
    again.role = ShotRole::kBracket;
    again.exposure.exposure_us = *bracket_us;
  } else {
    again.supersedes = index;
  }
  return again;
}

std::string file_stem(const DueShot& shot) {
  if (shot.role == ShotRole::kBelow) return fmt::format("{:02}_below", shot.index);
  const bool has_state = shot.polariser != Polariser::kNone;
  return fmt::format("{:02}_led{:02}{}{}{}", shot.index, shot.led, has_state ? "_" : "",
                     has_state ? weft::name_of(shot.polariser) : "",
                     shot.role == ShotRole::kBlade ? "_blade" : "");
}

std::vector<DueShot> missing_shots(const std::vector<DueShot>& plan, const Session& session) {
  std::vector<DueShot> missing;
  std::copy_if(plan.begin(), plan.end(), std::back_inserter(missing), [&](const DueShot& planned) {
    return std::none_of(session.shots.begin(), session.shots.end(),
                        [&](const Shot& shot) { return shot.index == planned.index; });
  });
  return missing;
}

double nearest_time_us(const std::vector<double>& times_us, double wanted_us) {
  const auto distance = [&](double time_us) { return std::abs(std::log(time_us / wanted_us)); };
  const auto nearest = std::min_element(times_us.begin(), times_us.end(),
                                        [&](double a, double b) { return distance(a) < distance(b); });
  return nearest == times_us.end() ? wanted_us : *nearest;
}

Result<double> settable_time_us(const std::vector<double>& times_us, double wanted_us) {
  const bool is_beyond = !times_us.empty() && (wanted_us * kHalfAStep < times_us.front() ||
                                               wanted_us > times_us.back() * kHalfAStep);
  if (!is_beyond) return nearest_time_us(times_us, wanted_us);
  return Error{
      ErrorKind::kUsage, "the camera has no such exposure", exposure_words(wanted_us),
      fmt::format("it has {} to {}", exposure_words(times_us.front()), exposure_words(times_us.back())),
      "ask for one of those: 20ms, 1/60 and 0.5s are exposures"};
}

std::string nearest_time_words(double wanted_us, double settable_us) {
  if (std::abs(settable_us / wanted_us - 1) <= kSameTime) return "";
  return fmt::format("{} is the exposure that the camera has nearest to {}", exposure_words(settable_us),
                     exposure_words(wanted_us));
}

std::string name_of(const DueShot& shot) {
  switch (shot.role) {
    case ShotRole::kDark:
      return "the dark shot";
    case ShotRole::kRepeat:
      return shot.led == 0 ? "the dark shot at the end" : fmt::format("the repeat of LED {}", shot.led);
    case ShotRole::kBracket:
      return fmt::format("the bracket of LED {}", shot.led);
    case ShotRole::kBelow:
      return "the shot of the light below";
    case ShotRole::kBlade:
      return fmt::format("LED {} with the blade", shot.led);
    case ShotRole::kLit:
      break;
  }
  return fmt::format("LED {}", shot.led);
}

std::vector<std::string> bracket_warnings(const ShotList& list, double exposure_us, double bracket_us,
                                          const std::optional<Calibration>& calibration) {
  constexpr double kSixthOfAStop = 0.116;
  if (!list.bracket) return {};
  std::vector<std::string> warnings;
  const double ratio = bracket_us / exposure_us;
  if (std::abs(std::log(ratio / *list.bracket)) > kSixthOfAStop) {
    warnings.push_back(
        fmt::format("the brackets are {:.3g} times the exposure, not {:.3g}: the camera has no shutter time "
                    "nearer to that",
                    ratio, *list.bracket));
  }
  if (!calibration || !calibration->response ||
      calibration->response->exposure_ratio(bracket_us, exposure_us))
    return warnings;
  warnings.push_back(fmt::format(
      "the calibration has no measured ratio of {} to {}, without which the brackets are not used: "
      "measure it with weft calibrate response",
      exposure_words(bracket_us), exposure_words(exposure_us)));
  return warnings;
}

}  // namespace weft::capture
