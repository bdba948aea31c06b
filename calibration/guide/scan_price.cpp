// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/scan_price.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include "core/base/iso_time.h"
#include "core/base/statistics.h"
#include "core/solve/solve.h"

namespace weft::calibration {
namespace {

using capture::ShotList;
using solver::LightPlan;
using solver::LightSet;

constexpr std::size_t kFewestLeds = 3, kFewestTimes = 3;
// By three to ten LEDs.
constexpr std::array<double, 8> kClothByLeds_deg = {7.31, 7.08, 6.2, 5.1, 4.44, 3.34, 3.09, 2.83};
constexpr int kMeterShots = 2;  // a scan of known lights begins with so many test shots
constexpr double kNever = std::numeric_limits<double>::infinity();

std::string words_of_list(const ShotList& list) {
  std::string words = fmt::format("{} LED{}", list.leds.size(), list.leds.size() == 1 ? "" : "s");
  if (list.repeat) words += ", repeat";
  if (list.bracket) words += fmt::format(", bracket x{:g}", *list.bracket);
  if (list.polariser.size() > 1) words += ", both films";
  if (list.below) words += ", from below";
  return words;
}

double seconds_of(const ShotList& list, const ShotCost& cost) {
  double seconds = (list.count() + kMeterShots) * cost.shot_s;
  if (list.bracket) seconds += static_cast<double>(list.leds.size()) * (*list.bracket - 1) * cost.exposure_s;
  return seconds;
}

ShotsPrice counted(const ShotList& list, const std::optional<ShotCost>& cost) {
  ShotsPrice price;
  price.list = list;
  price.what = words_of_list(list);
  price.shots = list.count();
  if (!cost) return price;
  price.seconds = seconds_of(list, *cost);
  price.bytes = price.shots * cost->bytes;
  return price;
}

double cost_of(const ShotsPrice& price) {
  return price.seconds.value_or(price.shots);
}

double badness_of(const ShotsPrice& price) {
  return price.of_whole_deg().value_or(kNever);
}

double light_of(const ShotsPrice& price) {
  return price.light_deg.value_or(kNever);
}

double cloth_deg_by(std::size_t leds) {
  return kClothByLeds_deg[std::clamp(leds, kFewestLeds, kFewestLeds + kClothByLeds_deg.size() - 1) -
                          kFewestLeds];
}

double badness_of(const solver::ForeseenSigma& sigma) {
  return std::isfinite(sigma.normal_deg) ? deg_of_whole(sigma.normal_deg, 1 - sigma.unsolved) : kNever;
}

LightSet lights_of(const ShotList& list) {
  LightSet set;
  for (const int led : list.leds) set.leds.push_back(static_cast<std::size_t>(led - 1));
  set.bracket = list.bracket;
  set.has_polarisers = list.polariser.size() > 1;
  set.fade = list.repeat ? 0 : kUnseenFade;
  return set;
}

// All lists that are priced, foretold one by one.
class PricedLists {
 public:
  PricedLists(const LightPlan& plan, const ScanPriceOptions& options) : plan_(plan), options_(options) {}

  std::vector<ShotsPrice> take() {
    add(options_.asked);
    prices_.back().is_asked = true;
    for (std::vector<int> leds = options_.asked.leds; leds.size() >= kFewestLeds; leds = without_least(leds))
      add_all(leds);
    return std::move(prices_);
  }

 private:
  void add(const ShotList& list) {
    ShotsPrice price = counted(list, options_.cost);
    const solver::ForeseenSigma sigma = plan_.sigma_of(lights_of(list));
    price.solved = 1 - sigma.unsolved;
    price.cloth_deg = cloth_deg_by(list.leds.size());
    if (std::isfinite(sigma.normal_deg)) {
      price.light_deg = sigma.normal_deg;
      price.predicted_deg = std::hypot(sigma.normal_deg, price.cloth_deg);
    }
    prices_.push_back(std::move(price));
  }

  void add_all(const std::vector<int>& leds) {
    std::vector<std::optional<double>> brackets = {std::nullopt};
    if (options_.may_bracket) brackets.emplace_back(options_.asked.bracket.value_or(kUsualBracket));
    for (const bool repeat : {false, true}) {
      for (const std::optional<double>& bracket : brackets) {
        ShotList list = options_.asked;
        list.leds = leds;
        list.repeat = repeat;
        list.bracket = bracket;
        for (const bool two : {false, true}) {
          if (two && !options_.has_two_films) continue;
          if (options_.has_two_films) list.polariser.resize(1);
          if (two) list.polariser = {Polariser::kCrossed, Polariser::kParallel};
          add(list);
        }
      }
    }
  }

  // All but the LED that is missed least.
  std::vector<int> without_least(const std::vector<int>& leds) const {
    std::vector<int> best;
    double least = kNever;
    for (std::size_t k = 0; k < leds.size(); ++k) {
      ShotList list = options_.asked;
      list.leds = leds;
      list.leds.erase(list.leds.begin() + static_cast<std::ptrdiff_t>(k));
      const double deg = badness_of(plan_.sigma_of(lights_of(list)));
      if (!best.empty() && !(deg < least)) continue;
      least = deg;
      best = std::move(list.leds);
    }
    return best;
  }

  const LightPlan& plan_;
  const ScanPriceOptions& options_;
  std::vector<ShotsPrice> prices_;
};

// From the cheapest to the best: each is better than all that are cheaper, or is what is asked for.
std::vector<ShotsPrice> worth_telling(std::vector<ShotsPrice> all) {
  std::ranges::stable_sort(all, [](const ShotsPrice& a, const ShotsPrice& b) {
    return std::pair(cost_of(a), badness_of(a)) < std::pair(cost_of(b), badness_of(b));
  });
  std::vector<ShotsPrice> told;
  double best = kNever;
  for (ShotsPrice& price : all) {
    const bool is_better = badness_of(price) < best;
    best = std::min(best, badness_of(price));
    const bool is_told = !told.empty() && told.back().is_asked && told.back().what == price.what;
    if ((is_better || price.is_asked) && !is_told) told.push_back(std::move(price));
  }
  return told;
}

Error none_fits(const std::vector<ShotsPrice>& rows, const ShotsWish& wish) {
  std::string asked;
  if (wish.to_deg) asked += fmt::format("--to {:g} degrees", *wish.to_deg);
  if (wish.within_s) asked += fmt::format("{}--within {:g} s", wish.to_deg ? ", " : "", *wish.within_s);
  const ShotsPrice& least = rows.front();
  const auto best = std::ranges::min_element(rows, {}, [](const ShotsPrice& row) { return badness_of(row); });
  const auto in_words = [](const ShotsPrice& row) {
    const std::string degrees =
        std::isfinite(badness_of(row)) ? fmt::format("{:.3g} degrees", badness_of(row)) : "no normals";
    return row.seconds ? fmt::format("{} has {} in {:.3g} s", row.what, degrees, *row.seconds)
                       : fmt::format("{} has {} by {} shots", row.what, degrees, row.shots);
  };
  return {ErrorKind::kUsage, "no list of shots is that close and that quick", std::move(asked),
          fmt::format("the best, {}; the quickest, {}", in_words(*best), in_words(least)),
          "ask for what weft scan --explain lists"};
}

// Whether the row is as quick as is wished; what nobody can price in seconds is not.
bool is_quick(const ShotsPrice& row, const ShotsWish& wish) {
  return !wish.within_s || (row.seconds && *row.seconds <= *wish.within_s);
}

Result<void> choose(std::vector<ShotsPrice>& rows, const ShotsWish& wish) {
  double best = kNever, best_light = kNever;
  for (const ShotsPrice& row : rows) {
    if (is_quick(row, wish)) best = std::min(best, badness_of(row));
  }
  const double enough = wish.to_deg ? *wish.to_deg : best * (1 + kNothingToGain);
  const auto fits = [&](const ShotsPrice& row) {
    return is_quick(row, wish) && std::isfinite(badness_of(row)) && badness_of(row) <= enough;
  };
  for (const ShotsPrice& row : rows) {
    if (fits(row)) best_light = std::min(best_light, light_of(row));
  }
  const auto chosen = std::ranges::find_if(rows, [&](const ShotsPrice& row) {
    return fits(row) && (wish.to_deg || light_of(row) <= best_light * (1 + kNothingToGain));
  });
  if (chosen != rows.end()) {
    chosen->is_chosen = true;
    return {};
  }
  return wish.is_one() ? Result<void>(none_fits(rows, wish)) : Result<void>();
}

Result<void> check_known(const std::optional<solver::ForeseenRig>& rig, const ScanPriceOptions& options) {
  const auto refuse = [](const char* what, const char* where, const char* remedy) {
    return Error{ErrorKind::kUsage, "the shots cannot be chosen", where, what, remedy};
  };
  if (!rig && options.wish.is_one())
    return refuse("nobody knows where this rig's LEDs are", "--to, --within", "calibrate its lights first");
  if (options.wish.within_s && !options.cost)
    return refuse("no scan of this rig has told what a shot takes", "--within",
                  "scan one cloth first, or choose by --to DEGREES");
  return {};
}

std::vector<std::string> notes_of(const std::optional<solver::ForeseenRig>& rig,
                                  const ScanPriceOptions& options) {
  std::vector<std::string> notes;
  if (!rig) notes.emplace_back("no degrees: nobody knows where this rig's LEDs are");
  if (rig) {
    notes.push_back(fmt::format(
        "light: by its noise and the calibration on cloth like {}, of which it tells that share; without a "
        "repeat LEDs fade by {:g} percent unseen. cloth: what shadows and gloss of cloths were off by in the "
        "mean by so many LEDs at the level standard; weft solve --explain says it of this one",
        options.cloth.name, 100 * kUnseenFade));
  }
  if (!options.cost) notes.emplace_back("no seconds: no scan of this rig has told what a shot takes");
  if (rig && !options.may_bracket)
    notes.emplace_back("no brackets: the calibration has measured no ratios of exposures");
  return notes;
}

}  // namespace

std::optional<double> ShotsPrice::of_whole_deg() const {
  return predicted_deg ? std::optional(deg_of_whole(*predicted_deg, solved)) : std::nullopt;
}

std::optional<ShotCost> shot_cost_of(const Session& session) {
  std::vector<double> times, between;
  ShotCost cost;
  double frames = 0;
  for (const Shot& shot : session.shots) {
    if (const std::optional<double> time = seconds_of_iso_time(shot.time)) times.push_back(*time);
    std::error_code none;
    const auto bytes = std::filesystem::file_size(session.path_of(shot), none);
    if (shot.role != ShotRole::kLit || none) continue;
    cost.exposure_s = 1e-6 * shot.exposure_us;
    cost.bytes += static_cast<double>(bytes);
    ++frames;
  }
  if (times.size() < kFewestTimes || frames == 0) return {};
  std::ranges::sort(times);
  for (std::size_t i = 1; i < times.size(); ++i) between.push_back(times[i] - times[i - 1]);
  cost.shot_s = median(between);
  cost.bytes /= frames;
  return cost;
}

Result<ScanPrices> price_scan(const std::optional<solver::ForeseenRig>& rig,
                              const ScanPriceOptions& options) {
  if (Result<void> ok = check_known(rig, options); !ok) return std::move(ok).error();
  ScanPrices prices = {options.cloth.name, {}, notes_of(rig, options)};
  if (!rig) {
    prices.rows.push_back(counted(options.asked, options.cost));
    prices.rows.back().is_asked = true;
    return prices;
  }
  const LightPlan plan(*rig, options.cloth.cloth);
  prices.rows = worth_telling(PricedLists(plan, options).take());
  if (Result<void> ok = choose(prices.rows, options.wish); !ok) return std::move(ok).error();
  return prices;
}

void describe(Fields& fields, ShotsPrice& price) {
  fields.value({"what", "In words"}, price.what);
  fields.value({"leds", "That are lit, numbered from 1"}, price.list.leds);
  fields.value({"repeat", "The first LED and the dark shot once more"}, price.list.repeat);
  fields.value(
      {.name = "bracket", .says = "Each LED once more at so many times the exposure", .need = kOrNull},
      price.list.bracket);
  std::vector<std::string> films;
  for (const Polariser state : price.list.polariser) films.emplace_back(name_of(state));
  fields.value({"polariser", "How the films stand for each LED"}, films);
  fields.value({"shots", "Photographs"}, price.shots);
  fields.value({.name = "seconds", .says = "By the rig's last scan", .need = kOrNull}, price.seconds);
  fields.value({.name = "bytes", .says = "On the disk", .need = kOrNull}, price.bytes);
  fields.value({.name = "light_deg",
                .says = "Standard deviation of a normal by light, sensor and calibration, degrees",
                .need = kOrNull},
               price.light_deg);
  fields.value({"cloth_deg", "Mean error of cloths by so many LEDs, as docs/measured/accuracy.md has it"},
               price.cloth_deg);
  fields.value({.name = "predicted_deg", .says = "Of both", .need = kOrNull}, price.predicted_deg);
  fields.value({"solved", "Share of the cloth whose normals are told", {0, 1}}, price.solved);
  fields.value({"asked", "It is what the request has"}, price.is_asked);
  fields.value({"chosen", "The one to buy"}, price.is_chosen);
}

void describe(Fields& fields, ScanPrices& prices) {
  fields.value({"cloth", "What the cloth is taken to be like"}, prices.cloth);
  fields.list({"rows", "From the cheapest; dearer ones that are no better are left out"}, prices.rows);
  fields.value({"notes", "What the figures are of"}, prices.notes);
}

}  // namespace weft::calibration
