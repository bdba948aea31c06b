// SPDX-License-Identifier: Apache-2.0
#include "library/import/led_decision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/statistics.h"
#include "core/base/text.h"
#include "library/import/capture_order.h"
#include "library/import/import_checks.h"

namespace weft::library {
namespace {

constexpr double kDarkLevel = 0.1;  // of the median level: no LED lit, or one did not light
constexpr double kAlike = 0.05;     // of a frame's level: two photographs under one light
constexpr const char* kNotAsked = "the light was not asked: it takes five lit frames";

using Indices = std::vector<std::size_t>;

/// Brings frames and LEDs together, step by step; a step that refuses ends it.
class Decider {
 public:
  Decider(const std::vector<SourceFrame>& frames, const std::vector<std::vector<double>>& light,
          const capture::PatchLights& model, const DecisionOptions& options)
      : frames_(frames), light_(light), model_(model), options_(options) {}

  LedDecision decided() {
    // What names say is wrong says more than that two frames are one.
    if (check_most() && (is_by_number() || find_copies()) && find_dark() && check_numbers() &&
        find_copies() && put_in_order() && ask_light())
      warn();
    return std::move(decision_);
  }

 private:
  int led_count() const { return static_cast<int>(model_.leds.size()); }
  const std::string& label(std::size_t f) const { return frames_[f].label; }
  bool is_by_number() const {
    return options_.is_numbered &&
           (options_.order == FrameOrder::kAuto || options_.order == FrameOrder::kName);
  }

  bool refuse(std::string what, std::string why, std::string remedy) {
    decision_.leds.clear();
    decision_.refusal = Error{ErrorKind::kBadData, std::move(what), "", std::move(why), std::move(remedy)};
    return false;
  }

  bool refuse_more(std::size_t frames) {
    std::vector<std::string> undated;
    for (const SourceFrame& frame : frames_)
      if (!frame.taken_s) undated.push_back(frame.label);
    const bool is_some = !undated.empty() && undated.size() < frames_.size();
    return refuse("there are more frames than LEDs",
                  fmt::format("{} frames, {} LEDs{}", frames, led_count(),
                              is_some ? fmt::format("; gaps tell nothing of {} without a time: {}",
                                                    undated.size(), first_few(undated))
                                      : ""),
                  is_some ? "put those without a time aside, or say {session} in --pattern"
                          : "tell sessions apart by --gap SECONDS or {session} in --pattern");
  }

  bool check_most() {
    const bool is_too_many = !is_by_number() && frames_.size() > model_.leds.size() + 1;
    return !is_too_many || refuse_more(frames_.size());
  }

  /// Two photographs of one thing differ by their noise; of nothing, by their headers.
  bool find_copies() {
    for (std::size_t a = 0; a < frames_.size(); ++a) {
      const double level = level_of(light_[a]);
      for (std::size_t b = a + 1; b < frames_.size(); ++b) {
        if (!are_equal(light_[a], light_[b])) continue;
        const bool is_file_twice = hold_same_bytes(frames_[a].source.file, frames_[b].source.file);
        if (!is_file_twice && (level == 0 || level >= 1)) continue;
        return refuse("two frames are one photograph",
                      fmt::format("{} and {} {}{}", label(a), label(b),
                                  is_file_twice ? "are one file, byte for byte" : "hold the same counts",
                                  is_any_dark() ? "" : ", and no frame is dark"),
                      "take the copy out, and look for the frame in whose place it is");
      }
    }
    return true;
  }

  /// With what is clipped.
  static bool are_equal(const std::vector<double>& a, const std::vector<double>& b) {
    return std::ranges::equal(a, b,
                              [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
  }

  std::vector<double> levels() const {
    std::vector<double> levels;
    for (const auto& light : light_) levels.push_back(level_of(light));
    return levels;
  }
  bool is_any_dark() const {
    const std::vector<double> all = levels();
    return std::ranges::min(all) < kDarkLevel * median(all);
  }

  bool find_dark() {
    const std::vector<double> levels = this->levels();
    const double dark_below = kDarkLevel * median(levels);
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      const bool is_dark = levels[f] < dark_below;
      if (is_dark) unlit_.push_back(f);
      const bool is_said = options_.is_numbered && frames_[f].said.led == 0;
      if (is_said && !is_dark) {
        return refuse("a frame that should be dark is lit", fmt::format("{} says LED 0", label(f)),
                      "number LEDs from 1; where names count from 0, write {index} in place of {led}");
      }
      if (!(options_.is_numbered ? is_said : is_dark)) continue;
      if (dark_) {
        return refuse("there are two dark frames", fmt::format("{} and {}", label(*dark_), label(f)),
                      "keep one dark frame; a LED that did not light leaves a session with one LED less "
                      "(--missing, with LEDs in names or --order light)");
      }
      dark_ = f;
    }
    for (std::size_t f = 0; f < frames_.size(); ++f)
      if (f != dark_) lit_.push_back(f);
    return true;
  }

  /// LEDs that names say, as far as they are asked; and how many frames there are.
  bool check_numbers() {
    if (is_by_number()) {
      std::vector<std::optional<std::size_t>> has(model_.leds.size() + 1);
      for (const std::size_t f : lit_) {
        const int led = *frames_[f].said.led;
        if (led > led_count()) {
          return refuse("a frame is of a LED that there is not",
                        fmt::format("{} says LED {}, the calibration has {}", label(f), led, led_count()),
                        "name the calibration of that rig, or another --pattern");
        }
        auto& first = has[static_cast<std::size_t>(led)];
        if (first) {
          return refuse(fmt::format("two frames are of LED {}", led),
                        fmt::format("{} and {}", label(*first), label(f)),
                        "put one of them aside, or tell sessions apart with {session} in --pattern");
        }
        first = f;
      }
    }
    if (!dark_ && lit_.size() == model_.leds.size() + 1) return refuse_no_dark();
    if (lit_.size() > model_.leds.size()) return refuse_more(lit_.size());
    return lit_.size() == model_.leds.size() || check_missing();
  }

  bool refuse_no_dark() {
    const std::vector<double> all = levels();
    const auto darkest = static_cast<std::size_t>(std::ranges::min_element(all) - all.begin());
    std::string alike;
    double least = kAlike;
    for (std::size_t a = 0; a < frames_.size(); ++a) {
      for (std::size_t b = a + 1; b < frames_.size(); ++b) {
        std::vector<double> apart = light_[a];
        for (std::size_t i = 0; i < apart.size(); ++i) apart[i] = std::abs(apart[i] - light_[b][i]);
        if (level_of(apart) >= least * all[a]) continue;
        least = level_of(apart) / all[a];
        alike = fmt::format("; {} and {} are of one light", label(a), label(b));
      }
    }
    return refuse(
        "no frame is dark",
        fmt::format("{} frames and {} LEDs, and the darkest, {}, has {:.0f} percent of the others' light{}",
                    frames_.size(), led_count(), label(darkest), 100 * all[darkest] / median(all), alike),
        "take the frame out that is no dark shot though it should be one (a LED or a lamp was on), or "
        "tell sessions apart by --gap SECONDS");
  }

  bool check_missing() {
    const std::string counts = fmt::format("{} lit frames, {} LEDs", lit_.size(), led_count());
    const bool knows_which = is_by_number() || options_.order == FrameOrder::kLight;
    if (lit_.size() < 3)
      return refuse("there are too few frames", counts, "a session has at least three lit frames");
    if (!knows_which) {
      return refuse("frames are missing", counts + ", and no order tells which are missing",
                    "look for the frames, or take --order light --missing");
    }
    if (options_.takes_missing) return true;
    std::string missing;
    for (int led = 1; is_by_number() && led <= led_count(); ++led) {
      if (std::ranges::none_of(lit_, [&](std::size_t f) { return frames_[f].said.led == led; }))
        missing += fmt::format("{}{}", missing.empty() ? ": no frame of LED " : ", ", led);
    }
    return refuse("frames are missing", counts + missing, "look for the frames, or take --missing");
  }

  /// LEDs in this order of all frames.
  std::vector<int> counted(const Indices& order) const {
    std::vector<int> leds(frames_.size());
    int led = 0;
    for (const std::size_t f : order) leds[f] = f == dark_ ? 0 : ++led;
    return leds;
  }

  bool put_in_order() {
    const std::vector<int> names = counted(order_of_names(frames_));
    const std::optional<Indices> order = order_of_times(frames_);
    std::optional<std::vector<int>> times;
    if (order) times = counted(*order);
    if (is_by_number()) {
      for (std::size_t f = 0; f < frames_.size(); ++f)
        decision_.leds.push_back(f == dark_ ? 0 : *frames_[f].said.led);
      decision_.by = "numbers in names";
      decision_.opinions.push_back({"numbers", decision_.leds});
      return true;
    }
    const bool is_whole = lit_.size() == model_.leds.size();
    if (times && is_whole) decision_.opinions.push_back({"time", *times});
    if (is_whole) decision_.opinions.push_back({"names", names});
    switch (options_.order) {
      case FrameOrder::kTime:
        if (!times) return refuse_without_time();
        decision_.by = "times";
        decision_.leds = *times;
        return true;
      case FrameOrder::kLight:
        decision_.by = "light";
        return true;
      case FrameOrder::kName:
        decision_.by = "names";
        decision_.leds = names;
        return true;
      case FrameOrder::kAuto:
        break;
    }
    decision_.by = times ? "times and names" : "names";
    if (times && *times != names) {
      is_disputed_ = true;
    } else {
      decision_.leds = names;
    }
    return true;
  }

  bool refuse_without_time() {
    for (const SourceFrame& frame : frames_) {
      if (frame.taken_s) continue;
      return refuse("there is no order of time",
                    fmt::format("{} does not say when it was taken", frame.label),
                    "take --order name or --order light");
    }
    return refuse("there is no order of time", "", "take --order name or --order light");
  }

  std::vector<int> of_lit(const std::vector<int>& leds) const {
    std::vector<int> lit;
    for (const std::size_t f : lit_) lit.push_back(leds[f]);
    return lit;
  }
  std::vector<int> of_all(const std::vector<int>& lit) const {
    std::vector<int> leds(frames_.size(), 0);
    for (std::size_t i = 0; i < lit.size(); ++i) leds[lit_[i]] = lit[i];
    return leds;
  }

  std::vector<std::vector<double>> lit_light() const {
    std::vector<std::vector<double>> lit;
    for (const std::size_t f : lit_) {
      lit.push_back(light_[f]);
      for (std::size_t i = 0; dark_ && i < lit.back().size(); ++i) lit.back()[i] -= light_[*dark_][i];
    }
    return lit;
  }

  bool ask_light() {
    std::vector<std::vector<int>> starts;
    for (const LedOpinion& opinion : decision_.opinions) starts.push_back(of_lit(opinion.leds));
    const std::vector<std::vector<double>> light = lit_light();
    decision_.light = capture::assign_by_light(light, model_, starts, options_.stop);
    decision_.sure.resize(frames_.size());
    if (decision_.light) {
      decision_.opinions.push_back({"light", of_all(decision_.light->leds)});
      if (!decision_.light->is_alone())
        decision_.opinions.push_back({"light, second", of_all(decision_.light->second)});
    }
    if (options_.order == FrameOrder::kLight) return take_light();
    if (is_disputed_) return settle_dispute() || follow_counter() || refuse_disputed();
    if (!decision_.light) {
      decision_.light_says = kNotAsked;
      return true;
    }
    return compare_with_light(capture::misfit_under(of_lit(decision_.leds), light, model_));
  }

  std::string light_words() const {
    if (!decision_.light) return "";
    const double times = capture::times_better(decision_.light->misfit, decision_.light->second_misfit);
    return decision_.light->is_alone()
               ? fmt::format("; by the light one assignment stands alone, {:.1f} times better than the next",
                             times)
               : "; the light cannot tell either";
  }

  /// A counter that began again puts the last names first; the light says so where one assignment stands
  /// alone.
  bool settle_dispute() {
    if (lit_.size() != model_.leds.size()) return false;
    const std::vector<int> times = counted(*order_of_times(frames_));
    const Indices by_name = order_of_names(frames_), by_time = *order_of_times(frames_);
    const auto first = std::ranges::find(by_time, by_name.front());
    const bool began_again = std::equal(first, by_time.end(), by_name.begin()) &&
                             std::equal(by_time.begin(), first, by_name.begin() + (by_time.end() - first));
    const NameCount last = count_of(label(by_name.back())), next = count_of(label(by_name.front()));
    const bool at_its_end = last.end >= 1000 && last.end == next.end &&
                            last.number + frames_.size() > last.end && next.number <= frames_.size();
    if (!began_again || !at_its_end || !decision_.light || !decision_.light->is_alone() ||
        of_lit(times) != decision_.light->leds)
      return false;
    decision_.leds = times;
    decision_.by = "times";
    decision_.light_says = "the light agrees with times" + light_words();
    decision_.warnings.push_back({"the camera's counter began again",
                                  fmt::format("the camera's counter began again: {} follows {}, by time and "
                                              "light",
                                              label(by_name.front()), label(*std::prev(first)))});
    take_sureness();
    return true;
  }

  /// A camera counts on while its clock is set back; the light may object.
  bool follow_counter() {
    const std::optional<CountedOrder> by_count = counted_order(frames_);
    if (!by_count || lit_.size() != model_.leds.size()) return false;
    const std::vector<int> leds = counted(by_count->order);
    const double misfit = decision_.light ? capture::misfit_under(of_lit(leds), lit_light(), model_) : 0;
    const bool objects = decision_.light && of_lit(leds) != decision_.light->leds &&
                         capture::is_far_better(decision_.light->misfit, misfit);
    if (objects) return false;
    decision_.leds = leds;
    decision_.by = "names";
    decision_.order = by_count->order;
    decision_.warnings.push_back(
        {"the camera's clock was set back",
         words_of(by_count->steps.front(), frames_) + ": the order is that of names, which count on"});
    if (decision_.light) return compare_with_light(misfit);
    decision_.light_says = kNotAsked;
    return true;
  }

  bool refuse_disputed() {
    return refuse(
        "times and names do not agree on the order of the frames",
        "the camera's clock was set back, files were renamed, or its counter began again" + light_words(),
        "look at the table, then say --order time, name or light");
  }

  void take_sureness() {
    for (std::size_t i = 0; i < lit_.size(); ++i) decision_.sure[lit_[i]] = decision_.light->sure[i];
  }

  bool take_light() {
    if (!decision_.light) {
      return refuse("the light cannot tell LEDs apart",
                    fmt::format("{} lit frames with light in them; it takes five", lit_.size()),
                    "take --order time or name, or LEDs in names");
    }
    if (!decision_.light->is_alone()) {
      return refuse("two assignments of the LEDs explain the light alike",
                    fmt::format("they leave {:.4f} and {:.4f} of it", decision_.light->misfit,
                                decision_.light->second_misfit),
                    "look at the table, then say --order time or name, or write {led} in --pattern");
    }
    decision_.leds = of_all(decision_.light->leds);
    decision_.light_says = fmt::format("the light leaves {:.4f}, the next best assignment {:.4f}",
                                       decision_.light->misfit, decision_.light->second_misfit);
    take_sureness();
    return true;
  }

  bool compare_with_light(double misfit) {
    const capture::LightAssignment& light = *decision_.light;
    if (of_lit(decision_.leds) == light.leds) {
      decision_.light_says = light.is_alone()
                                 ? fmt::format("the light agrees: it leaves {:.4f}, the next best {:.4f}",
                                               light.misfit, light.second_misfit)
                                 : "the light agrees, but another assignment explains it as well";
      take_sureness();
      return true;
    }
    if (!capture::is_far_better(light.misfit, misfit)) {
      decision_.light_says = "the light does not object: another assignment explains it little better";
      return true;
    }
    decision_.light_says = fmt::format("the light objects: {} leave {:.4f} of it, another assignment {:.4f}",
                                       decision_.by, misfit, light.misfit);
    if (options_.order != FrameOrder::kAuto) {
      decision_.warnings.push_back({"the light objects", decision_.light_says});
      return true;
    }
    return refuse("the light of the frames says other LEDs than " + decision_.by,
                  fmt::format("they leave {:.4f} of it, another assignment {:.4f}", misfit, light.misfit),
                  "look at the table, then say --order light, time or name, or another --calibration");
  }

  void warn() {
    for (const std::size_t f : unlit_) {
      if (f == dark_) continue;
      decision_.warnings.push_back({"a LED did not light", fmt::format("{} is dark: LED {} did not light",
                                                                       label(f), decision_.leds[f])});
    }
    if (lit_.size() < model_.leds.size())
      decision_.warnings.push_back(
          {"LEDs are missing", fmt::format("{} of {} LEDs were lit", lit_.size(), led_count())});
    if (decision_.by != "light" && decision_.opinions.size() > 1) {
      const bool agrees = std::ranges::all_of(
          decision_.opinions, [&](const LedOpinion& opinion) { return opinion.leds == decision_.leds; });
      if (agrees) decision_.opinions.clear();
    }
  }

  const std::vector<SourceFrame>& frames_;
  const std::vector<std::vector<double>>& light_;
  const capture::PatchLights& model_;
  const DecisionOptions& options_;
  LedDecision decision_;
  std::optional<std::size_t> dark_;
  Indices lit_, unlit_;
  bool is_disputed_ = false;
};

}  // namespace

LedDecision decide_leds(const std::vector<SourceFrame>& frames, const std::vector<std::vector<double>>& light,
                        const capture::PatchLights& model, const DecisionOptions& options) {
  return Decider(frames, light, model, options).decided();
}

}  // namespace weft::library
