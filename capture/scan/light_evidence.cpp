// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/light_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/percent.h"
#include "core/base/statistics.h"
#include "core/rig/dark_counts.h"

namespace weft::capture {
namespace {

// Where evidence speaks. Measured over the example scenes: docs/measured/reliability.md.
constexpr double kLitFrom = 0.005;           // of full scale: the brightest patches of a frame that is lit
constexpr double kDarkTo = 0.02;             // of full scale: light in the dark shot that stops a scan
constexpr double kDarkLevel = 0.1;           // of the brightness that other LEDs let expect: did not light
constexpr double kDimLevel = 0.35;           // of the brightness fitted to the others: gave too little
constexpr double kDimWarns = 0.6;            // is only spoken of: glossy cloth may look so
constexpr double kSuspiciousMisfit = 0.002;  // below it the plan is believed without trying other stories
constexpr std::size_t kStoryStep = 5;        // every fifth patch is looked at: 48 columns have no factor 5
constexpr std::size_t kGlanceStep = 25;      // every 25th patch, to see which stories are worth that
constexpr double kWorthALook = 0.8;          // of the plan's misfit at that glance
constexpr double kMostFull = 0.5;            // of a frame's patches, for it to be held against the others
constexpr double kFarFromFull = 0.5;         // of full scale, as others let expect of a patch that is full
constexpr double kFarBetter = 0.6;       // of the plan's misfit, at most, for another story to be believed
constexpr double kBetterBy = 0.002;      // and by this at least
constexpr double kDriftWarns = 0.005;    // of a repeat's brightness
constexpr double kHidden = 0.5;          // of the light that a blade leaves to what lies in its shadow
constexpr double kRepeatLevel = 0.08;    // beyond it a repeat is not the same light
constexpr double kRepeatPattern = 0.05;  // scatter of a repeat over its first, beyond noise
constexpr double kDarkAlike = 3e-5;      // of full scale, between two dark shots: half a count of 14 bits
constexpr double kDarkNoise = 6;         // of their difference, beyond it they are not alike
constexpr double kMedianNoise = 1.86;    // of a median of normal deviates, from their median deviation
constexpr double kOtherSideBy = 0.05;    // less uneven over another LED's frame: that one was lit
constexpr double kBracketLevel = 0.25;   // of a bracket's brightness over the ratio of its times

/// The share of patches that hold a full photosite.
double full_share(const std::vector<double>& light) {
  const auto full = std::ranges::count_if(light, [](double v) { return std::isnan(v); });
  return static_cast<double>(full) / static_cast<double>(light.size());
}

/// Whether enough of a frame can be read for its light to tell something: what is left of one that is full is
/// where the light is weak.
bool is_readable(const std::vector<double>& light) {
  return full_share(light) <= kMostFull;
}

/// Whether no patch is lit, of a frame without its dark shot.
bool is_dark(const std::vector<double>& own) {
  return lower_quantile(finite(own), 0.99) < kLitFrom &&
         std::ranges::none_of(own, [](double v) { return std::isnan(v); });
}

/// What a frame has over another, and how unevenly.
struct Ratio {
  double median = 1;
  double scatter = 0;  ///< median deviation from it, relative
};

/// Nothing where one of the two is full everywhere.
std::optional<Ratio> ratio_of(const std::vector<double>& light, const std::vector<double>& before) {
  const double least = 0.2 * lower_quantile(finite(before), 0.5);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (std::isfinite(light[i]) && before[i] > least) ratios.push_back(light[i] / before[i]);
  }
  if (ratios.empty()) return std::nullopt;
  const double middle = median(ratios);
  for (double& ratio : ratios) ratio = std::abs(ratio / middle - 1);
  return Ratio{middle, median(std::move(ratios))};
}

/// What shines on a frame: a LED, and `times` as much of more light.
struct FrameLight {
  int led = 0;
  const std::vector<Vec3>* more = nullptr;  ///< by patch; none: the LED alone
  double times = 0;
  bool operator==(const FrameLight&) const = default;
};

using FrameLights = std::vector<FrameLight>;
using Readings = std::vector<const std::vector<double>*>;  ///< by frame

/// What may have happened in the place of the plan.
struct Story {
  LightFinding finding = LightFinding::kAgrees;
  std::string sentence;
  FrameLights lights;
};

const std::vector<Vec3>& light_of(int led, const PatchLights& model) {
  return model.leds[static_cast<std::size_t>(led - 1)];
}

PatchFit fit_of(const FrameLights& lights, const Readings& readings, const PatchLights& model,
                std::size_t step = kStoryStep) {
  std::vector<std::vector<Vec3>> sums;
  sums.reserve(lights.size());
  std::vector<const std::vector<Vec3>*> incident;
  for (const FrameLight& light : lights) {
    const std::vector<Vec3>& led = light_of(light.led, model);
    incident.push_back(&led);
    if (light.more == nullptr) continue;
    sums.push_back(led);
    for (std::size_t i = 0; i < led.size(); ++i) sums.back()[i] = led[i] + light.times * (*light.more)[i];
    incident.back() = &sums.back();
  }
  return fit_light(readings, incident, step);
}

double misfit_in(const FrameLights& lights, const Readings& readings, const PatchLights& model,
                 std::size_t step = kStoryStep) {
  return fit_of(lights, readings, model, step).misfit;
}

/// Another LED lights in the place of a frame's, or two LEDs are exchanged.
void add_exchanges(const FrameLights& planned, int leds, std::vector<Story>& stories) {
  for (std::size_t f = 0; f < planned.size(); ++f) {
    for (int led = 1; led <= leds; ++led) {
      if (led == planned[f].led) continue;
      stories.push_back(
          {LightFinding::kOther,
           fmt::format("LED {} lights where LED {} should: are their wires swapped?", led, planned[f].led),
           planned});
      stories.back().lights[f].led = led;
    }
    for (std::size_t g = f + 1; g < planned.size(); ++g) {
      stories.push_back({LightFinding::kOther,
                         fmt::format("LED {} lights where LED {} should and the other way round: are their "
                                     "wires swapped?",
                                     planned[g].led, planned[f].led),
                         planned});
      std::swap(stories.back().lights[f], stories.back().lights[g]);
    }
  }
}

/// Light that comes on with any of the frames and stays, or goes out again with a later one: somebody may
/// have mended it before the scan went on. `own_led` has it anyhow; 0: none has.
void add_more_light(const FrameLights& planned, const std::vector<Vec3>& more, double times, int own_led,
                    LightFinding finding, const std::string& sentence, std::vector<Story>& stories) {
  for (std::size_t from = 0; from < planned.size(); ++from) {
    if (planned[from].led == own_led) continue;
    Story story = {finding, sentence, planned};
    for (std::size_t f = from; f < planned.size(); ++f) {
      if (planned[f].led == own_led) continue;
      story.lights[f] = {planned[f].led, &more, times};
      stories.push_back(story);
    }
  }
}

/// Every likely mix-up.
std::vector<Story> stories_beside(const FrameLights& planned, const PatchLights& model) {
  std::vector<Story> stories;
  const int leds = static_cast<int>(model.leds.size());
  add_exchanges(planned, leds, stories);
  for (int led = 1; led <= leds; ++led) {
    add_more_light(planned, light_of(led, model), 1, led, LightFinding::kStaysLit,
                   fmt::format("LED {} stays lit", led), stories);
  }
  for (const double times : {0.1, 0.3, 1.0, 3.0}) {
    add_more_light(planned, model.room, times, 0, LightFinding::kRoomLight, "there is light beside the LEDs",
                   stories);
  }
  return stories;
}

/// The story that leaves the least, where that is far less than the plan leaves.
std::optional<Story> believed_story(const FrameLights& planned, const Readings& readings,
                                    const PatchLights& model, double misfit_as_planned) {
  if (misfit_as_planned < kSuspiciousMisfit) return {};
  const double worth = kWorthALook * misfit_in(planned, readings, model, kGlanceStep);
  double least = std::min(kFarBetter * misfit_as_planned, misfit_as_planned - kBetterBy);
  std::optional<Story> believed;
  for (Story& story : stories_beside(planned, model)) {
    if (misfit_in(story.lights, readings, model, kGlanceStep) >= worth) continue;
    const double misfit = misfit_in(story.lights, readings, model);
    if (misfit >= least) continue;
    least = misfit;
    believed = std::move(story);
  }
  return believed;
}

bool comes_and_goes(const Story& story) {
  return story.finding == LightFinding::kRoomLight || story.finding == LightFinding::kStaysLit;
}

}  // namespace

const char* code_of(LightFinding finding) {
  switch (finding) {
    case LightFinding::kAgrees:
      return "";
    case LightFinding::kDark:
      return "dark";
    case LightFinding::kDim:
      return "dim";
    case LightFinding::kOther:
      return "swapped";
    case LightFinding::kStaysLit:
      return "stays_lit";
    case LightFinding::kRoomLight:
      return "room_light";
    case LightFinding::kChanged:
      return "changed";
  }
  return "";
}

ScanEvidence::ScanEvidence(PatchGrid grid, std::optional<PatchLights> model, Polariser solved)
    : grid_(grid), model_(std::move(model)), solved_(solved) {}

std::vector<double> ScanEvidence::glance(const RawFrame& frame) const {
  return glance_at(frame, grid_, model_ ? model_->scale : GlanceScale());
}

void ScanEvidence::accept(const DueShot& shot, std::vector<double> light) {
  if (shot.role == ShotRole::kDark)
    dark_ = std::move(light);
  else if (shot.role == ShotRole::kLit && shot.polariser == solved_)
    lit_[shot.index] = {shot, std::move(light)};
  else if (shot.role == ShotRole::kLit)
    other_[shot.led] = shot.index;
}

void ScanEvidence::forget(int index) {
  lit_.erase(index);
  std::erase_if(other_, [index](const auto& each) { return each.second == index; });
}

const ScanEvidence::Seen* ScanEvidence::of_led(int led) const {
  const auto seen =
      std::find_if(lit_.begin(), lit_.end(), [&](const auto& each) { return each.second.shot.led == led; });
  return seen == lit_.end() ? nullptr : &seen->second;
}

std::vector<double> ScanEvidence::without_dark(const std::vector<double>& light) const {
  std::vector<double> left = light;
  for (std::size_t i = 0; dark_ && i < left.size(); ++i) left[i] -= (*dark_)[i];
  return left;
}

ShotVerdict ScanEvidence::judge(const DueShot& shot, const std::vector<double>& light) const {
  switch (shot.role) {
    case ShotRole::kDark:
      return judge_dark(shot, light);
    case ShotRole::kLit:
      return shot.polariser == solved_ ? judge_lit(shot, light) : judge_other_state(shot, light);
    case ShotRole::kRepeat:
      if (shot.led == 0) return judge_dark_again(light);
      break;
    case ShotRole::kBracket:
      break;
    case ShotRole::kBelow:
      return judge_below(light);
    case ShotRole::kBlade:
      return judge_blade(shot, light);
  }
  return judge_again(shot, light);
}

ShotVerdict ScanEvidence::judge_dark(const DueShot& shot, const std::vector<double>& light) const {
  const std::vector<double> readable = finite(light);
  const double bright = readable.empty() ? 1 : lower_quantile(readable, 0.9);
  if (bright > kDarkTo || !std::isfinite(light.front())) {
    return {
        LightFinding::kRoomLight,
        fmt::format("the dark shot is lit ({:.2g} of full scale): there is a lamp on in the room, or a LED "
                    "stays lit",
                    bright),
        {shot.index},
        {},
        {},
        {}};
  }
  ShotVerdict verdict;
  if (bright > kDarkWarns) {
    verdict.doubt = LightFinding::kRoomLight;
    verdict.warnings.push_back(
        fmt::format("the dark shot has {:.2g} of full scale; darken the room for cleaner maps", bright));
  }
  return verdict;
}

/// The middle of what the patches gained, by how well that is known. A lamp that was switched on fills them
/// all, so that none may be finite. So much as no first dark shot may have lit the others as well.
ShotVerdict ScanEvidence::judge_dark_again(const std::vector<double>& light) const {
  if (!dark_) return {};
  std::vector<double> gained;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (std::isfinite(light[i]) && std::isfinite((*dark_)[i])) gained.push_back(light[i] - (*dark_)[i]);
  }
  const double more = gained.empty() ? 1 : median(gained);
  for (double& each : gained) each = std::abs(each - more);
  const double noise =
      gained.empty() ? 0 : kMedianNoise * median(gained) / std::sqrt(static_cast<double>(gained.size()));
  ShotVerdict verdict;
  if (std::abs(more) < std::max(kDarkNoise * noise, kDarkAlike)) return verdict;
  if (more > kDarkTo) {
    verdict.finding = LightFinding::kRoomLight;
    verdict.sentence = fmt::format(
        "the dark shot at the end is brighter than the first by {} percent of full scale: a lamp in the room "
        "or a LED came on during the scan",
        percent_words(more));
    verdict.accuses_all = true;
    return verdict;
  }
  verdict.doubt = LightFinding::kRoomLight;
  verdict.warnings.push_back(
      fmt::format("the dark shot at the end is {} than the first by {} percent of full scale: the room's "
                  "light changed or the sensor warmed in between; scan again with the room dark",
                  more > 0 ? "brighter" : "darker", percent_words(std::abs(more))));
  return verdict;
}

double ScanEvidence::level_of(const DueShot& shot, const std::vector<double>& light) const {
  const auto of_flat_cloth = [&](int led, std::size_t i) { return light_of(led, *model_)[i].z; };
  std::vector<const Seen*> frames;
  for (const auto& [index, seen] : lit_) {
    if (is_readable(seen.light)) frames.push_back(&seen);
  }
  std::vector<double> levels;
  for (std::size_t i = 0; i < light.size(); ++i) {
    std::vector<double> albedo;
    for (const Seen* seen : frames) {
      const double z = of_flat_cloth(seen->shot.led, i);
      if (std::isfinite(seen->light[i]) && z > 0) {
        albedo.push_back((seen->light[i] - (dark_ ? (*dark_)[i] : 0)) / z);
      }
    }
    const double expected = median(std::move(albedo)) * of_flat_cloth(shot.led, i);
    if (expected > 0 && std::isfinite(light[i])) levels.push_back(light[i] / expected);
  }
  return levels.empty() ? 1 : median(std::move(levels));
}

bool ScanEvidence::is_one_too_full(const std::vector<Seen>& full, const std::vector<Seen>& others) const {
  Readings readings;
  std::vector<const std::vector<Vec3>*> incident;
  for (const Seen& other : others) {
    readings.push_back(&other.light);
    incident.push_back(&light_of(other.shot.led, *model_));
  }
  return std::ranges::any_of(full, [&](const Seen& frame) {
    const std::vector<double> expected =
        expected_light(readings, incident, light_of(frame.shot.led, *model_));
    std::size_t patches = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
      patches += std::isnan(frame.light[i]) && expected[i] < kFarFromFull;
    return static_cast<double>(patches) > kMostFull * static_cast<double>(expected.size());
  });
}

/// A frame that is full, this one or one before, which those that are not let expect far from full.
ShotVerdict ScanEvidence::judge_full(const DueShot& shot, const std::vector<double>& light) const {
  std::vector<Seen> full, others;
  for (const auto& [index, seen] : lit_)
    (is_readable(seen.light) ? others : full).push_back({seen.shot, without_dark(seen.light)});
  const bool is_full = !is_readable(light);
  (is_full ? full : others).push_back({shot, without_dark(light)});
  ShotVerdict verdict;
  if (!is_one_too_full(full, others)) return verdict;
  verdict.finding = LightFinding::kRoomLight;
  verdict.sentence = "a photograph is full where the others are far from it: there is light beside the LEDs";
  verdict.accuses_all = true;
  verdict.is_over = !is_full;
  return verdict;
}

ShotVerdict ScanEvidence::judge_lit(const DueShot& shot, const std::vector<double>& light) const {
  const std::vector<double> own = without_dark(light);
  const auto found = [&](LightFinding finding, std::string sentence) {
    return ShotVerdict{finding, std::move(sentence), {shot.index}, {}, {}, {}};
  };
  if (is_dark(own)) {
    return found(LightFinding::kDark, fmt::format("LED {} is dark", shot.led));
  }
  if (!model_ || lit_.empty()) return {};
  if (const ShotVerdict full = judge_full(shot, light); full.finding != LightFinding::kAgrees) return full;
  if (!is_readable(light)) {
    ShotVerdict verdict;
    verdict.warnings.push_back(
        fmt::format("LED {}: {:.0f} percent of the frame have full photosites, so that nothing tells whether "
                    "it was the right LED; scan again with a shorter exposure",
                    shot.led, 100 * full_share(light)));
    return verdict;
  }
  const double level = level_of(shot, own);
  if (level < kDarkLevel) return found(LightFinding::kDark, fmt::format("LED {} is dark", shot.led));
  ShotVerdict verdict = judge_pattern(shot, light);
  verdict.level = level;
  if (verdict.finding == LightFinding::kAgrees && level < kDimWarns) {
    verdict.doubt = LightFinding::kDim;
    verdict.warnings.push_back(
        fmt::format("LED {} gives {:.0f} percent of the light that the others let expect; look at it before "
                    "the next scan",
                    shot.led, 100 * level));
  }
  return verdict;
}

ShotVerdict ScanEvidence::judge_pattern(const DueShot& shot, const std::vector<double>& light) const {
  std::vector<Seen> frames;
  for (const auto& [index, seen] : lit_) {
    if (index != shot.index && is_readable(seen.light))
      frames.push_back({seen.shot, without_dark(seen.light)});
  }
  frames.push_back({shot, without_dark(light)});
  if (frames.size() < kEnoughForPatterns) return {};

  Readings readings;
  FrameLights planned;
  for (const Seen& seen : frames) {
    readings.push_back(&seen.light);
    planned.push_back({seen.shot.led, nullptr, 0});
  }
  ShotVerdict verdict;
  const PatchFit as_planned = fit_of(planned, readings, *model_);
  verdict.misfit = as_planned.misfit;
  if (const auto story = believed_story(planned, readings, *model_, as_planned.misfit)) {
    verdict.finding = story->finding;
    verdict.sentence = story->sentence;
    for (std::size_t f = 0; f < frames.size(); ++f)
      if (story->lights[f] != planned[f]) verdict.accused.push_back(frames[f].shot.index);
    verdict.accuses_all = comes_and_goes(*story);
    verdict.is_over = verdict.accuses_all && story->lights.back() == planned.back();
    return verdict;
  }
  const auto dimmest = std::ranges::min_element(as_planned.gain);
  if (const double share = *dimmest / median(as_planned.gain); share < kDimLevel) {
    const DueShot& dim = frames[static_cast<std::size_t>(dimmest - as_planned.gain.begin())].shot;
    verdict.finding = LightFinding::kDim;
    verdict.sentence =
        fmt::format("LED {} gives {:.0f} percent of the light it should", dim.led, 100 * share);
    verdict.accused = {dim.index};
    verdict.accuses_all = dim.index != shot.index;
  }
  return verdict;
}

/// Gloss comes and goes with the polariser, unevenly, but the light still falls from its own side: over the
/// frame of another LED this one is more uneven than over that of its own. Where it is the other way round,
/// the frame that the other LED has in this state may show this one. A lamp that came on looks so as well,
/// sooner over one LED than over another: no frame of this state is believed.
ShotVerdict ScanEvidence::judge_other_state(const DueShot& shot, const std::vector<double>& light) const {
  const std::vector<double> own = without_dark(light);
  const auto refuse = [&](LightFinding finding, std::string sentence) {
    return ShotVerdict{finding, std::move(sentence), {shot.index}, {}, {}, {}};
  };
  if (is_dark(own)) return refuse(LightFinding::kDark, fmt::format("LED {} is dark", shot.led));
  const Seen* first = of_led(shot.led);
  const std::optional<Ratio> ratio =
      first == nullptr ? std::nullopt : ratio_of(own, without_dark(first->light));
  if (!ratio) return {};
  ShotVerdict verdict;
  verdict.level = ratio->median;
  double least = std::min(kFarBetter * ratio->scatter, ratio->scatter - kOtherSideBy);
  for (const auto& [index, seen] : lit_) {
    const std::optional<Ratio> other = ratio_of(own, without_dark(seen.light));
    if (seen.shot.led == shot.led || !other || other->scatter >= least) continue;
    least = other->scatter;
    verdict = refuse(
        LightFinding::kOther,
        fmt::format("LED {} lights where LED {} should: are their wires swapped?", seen.shot.led, shot.led));
    for (const auto& [led, of_this_state] : other_) {
      if (led != shot.led) verdict.accused.push_back(of_this_state);
    }
  }
  return verdict;
}

/// A dense cloth lets nothing through, so that darkness is only spoken of.
ShotVerdict ScanEvidence::judge_below(const std::vector<double>& light) const {
  ShotVerdict verdict;
  if (!is_dark(without_dark(light))) return verdict;
  verdict.doubt = LightFinding::kDark;
  verdict.warnings.emplace_back(
      "no light comes through the cloth from below: it is dense, or the light below is out");
  return verdict;
}

ShotVerdict ScanEvidence::judge_blade(const DueShot& shot, const std::vector<double>& light) const {
  const Seen* first = of_led(shot.led);
  if (first == nullptr) return {};
  const std::vector<double> own = without_dark(light), before = without_dark(first->light);
  int patches = 0, lit = 0, hidden = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!std::isfinite(own[i]) || !std::isfinite(before[i]) || before[i] <= kDarkTo) continue;
    const double level = own[i] / before[i];
    ++patches;
    lit += std::abs(level - 1) < kRepeatLevel;
    hidden += level < kHidden;
  }
  ShotVerdict verdict;
  if (patches == 0 || (lit > 0 && hidden > 0)) return verdict;
  verdict.finding = lit > 0 ? LightFinding::kChanged : LightFinding::kDark;
  verdict.sentence =
      lit > 0 ? fmt::format("no shadow of a blade lies in the light of LED {}", shot.led)
              : fmt::format("LED {} is dark, or the blade hides the whole cloth from it", shot.led);
  verdict.accused = {shot.index};
  return verdict;
}

ShotVerdict ScanEvidence::judge_again(const DueShot& shot, const std::vector<double>& light) const {
  const Seen* first = of_led(shot.led);
  if (first == nullptr) return {};
  const double times = shot.exposure.exposure_us / first->shot.exposure.exposure_us;
  const std::vector<double> own = without_dark(light), before = without_dark(first->light);
  const std::optional<Ratio> ratio = ratio_of(own, before);
  if (!ratio) return {};
  ShotVerdict verdict;
  verdict.level = ratio->median / times;
  const bool is_repeat = shot.role == ShotRole::kRepeat;
  const auto refuse = [&](LightFinding finding, std::string sentence) {
    verdict.finding = finding;
    verdict.sentence = std::move(sentence);
    verdict.accused = {shot.index};
    verdict.accuses_all = is_repeat && finding == LightFinding::kChanged;
  };
  const double off = std::abs(*verdict.level - 1);
  if (*verdict.level < kDarkLevel) {
    refuse(LightFinding::kDark, fmt::format("LED {} is dark", shot.led));
  } else if (off > (is_repeat ? kRepeatLevel : kBracketLevel)) {
    refuse(LightFinding::kChanged,
           fmt::format("{} is {:.2f} times as bright as its first photograph lets expect", name_of(shot),
                       *verdict.level));
  } else if (is_repeat && ratio->scatter > kRepeatPattern) {
    refuse(LightFinding::kChanged,
           fmt::format(
               "{} differs from its first photograph by {:.0f} percent from place to place: the cloth or "
               "the camera was moved, another light is on, or the LEDs flicker",
               name_of(shot), 100 * ratio->scatter));
  } else if (is_repeat && off > kDriftWarns) {
    verdict.doubt = LightFinding::kChanged;
    verdict.warnings.push_back(fmt::format(
        "LED {} gave {:.1f} percent {} light at the end than at first: LEDs drift while they warm "
        "up; let each be lit once before the next scan",
        shot.led, 100 * off, *verdict.level < 1 ? "less" : "more"));
  }
  return verdict;
}

}  // namespace weft::capture
