// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/meter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "capture/scan/scan_plan.h"
#include "core/rig/exposed.h"
#include "core/rig/exposure_words.h"

namespace weft::capture {
namespace {

constexpr int kMostTries = 8;           // of one LED until its test shot is neither full nor dark
constexpr double kReadableFrom = 0.05;  // 99.9 percent of a test shot below less than this: too dark to tell
constexpr double kReadableTo = 0.97;
constexpr double kStepDown = 0.125, kMostStepUp = 32;
constexpr double kMostOverStart = 100;  // where the light is known: no cloth reflects less than 1 percent
constexpr double kAgree = 0.1;          // of two LEDs' brightness with what the lights let expect
constexpr double kPoorRange = 0.5;      // 99.9 percent below less than this share of white
constexpr double kLongestBracket = 100;
constexpr double kWhite = 0.8;  // albedo that the first test shot holds
constexpr double kStart_us = 1e6 / 125;

/// What a LED gives a microsecond.
double rate_of(const MeteredShot& shot) {
  return shot.seen.bright / shot.exposure_us;
}

/// The longest time that is not above (by a percent, which no shutter keeps); the shortest where all are.
double longest_below(const std::vector<double>& times_us, double wanted_us) {
  if (times_us.empty()) return std::floor(wanted_us);
  const auto above = std::upper_bound(times_us.begin(), times_us.end(), 1.01 * wanted_us);
  return above == times_us.begin() ? times_us.front() : *std::prev(above);
}

/// Takes what to expect from the calibrated lights.
void expect_light(MeterInput& input, const PatchLights& lights, double iso) {
  for (const int led : input.leds) {
    double brightest = 0;
    for (const Vec3& s : lights.leds[static_cast<std::size_t>(led - 1)]) brightest = std::max(brightest, s.z);
    input.expected.push_back(brightest);
  }
  const double most = *std::ranges::max_element(input.expected);
  input.start_us = 1e6 * kMeteredTo / (kWhite * most * lights.reading * iso / 100);
}

Json to_json(const MeteredShot& shot) {
  return {{"led", shot.led},
          {"exposure_us", shot.exposure_us},
          {"bright", shot.seen.bright},
          {"brightest", shot.seen.brightest},
          {"clipped", shot.seen.clipped}};
}

class Meter {
 public:
  Meter(const MeterInput& input, const TestShot& shoot)
      : input_(input),
        shoot_(shoot),
        longest_us_(input.expected.empty() ? std::numeric_limits<double>::infinity()
                                           : kMostOverStart * input.start_us),
        exposure_us_(settable(input.start_us)) {}

  Result<Metering> run() {
    if (Result<void> tried = try_leds(); !tried) return tried.error();
    const MeteredShot& brightest = *std::ranges::min_element(shots_, {}, &MeteredShot::longest_us);
    Metering metering;
    metering.led = brightest.led;
    metering.wanted_us = brightest.longest_us();
    metering.exposure_us = longest_below(input_.shutter_times_us, metering.wanted_us);
    judge_range(brightest, metering);
    metering.test_shots = std::move(shots_);
    return metering;
  }

 private:
  double settable(double wanted_us) const { return nearest_time_us(input_.shutter_times_us, wanted_us); }

  Result<void> try_leds() {
    if (input_.expected.empty()) return try_each(input_.leds);
    const auto [least, most] = std::minmax_element(input_.expected.begin(), input_.expected.end());
    const int bright = led_at(most), dark = led_at(least);
    if (Result<void> tried = try_each({bright}); !tried) return tried;
    if (dark == bright) return {};
    if (Result<void> tried = try_each({dark}); !tried) return tried;
    const double off = rate_of(shots_[1]) / rate_of(shots_[0]) / (*least / *most) - 1;
    if (std::abs(off) <= kAgree) return {};
    std::vector<int> others = input_.leds;
    std::erase_if(others, [&](int led) { return led == bright || led == dark; });
    return try_each(others);
  }

  int led_at(std::vector<double>::const_iterator expected) const {
    return input_.leds[static_cast<std::size_t>(expected - input_.expected.begin())];
  }

  Result<void> try_each(const std::vector<int>& leds) {
    for (const int led : leds) {
      const Result<MeteredShot> shot = try_led(led);
      if (!shot) return shot.error();
      shots_.push_back(*shot);
    }
    return {};
  }

  /// Shorter or longer until the test shot can be read; the next LED starts where this one ended.
  Result<MeteredShot> try_led(int led) {
    Brightness seen;
    for (int i = 0; i < kMostTries; ++i) {
      const Result<Brightness> brightness = shoot_(led, exposure_us_);
      if (!brightness) return brightness.error();
      seen = *brightness;
      const MeteredShot shot = {led, exposure_us_, seen};
      if (shot.is_readable()) return shot;
      const double next_us = settable(std::min(shot.next_us(), longest_us_));
      if (next_us == exposure_us_) break;
      exposure_us_ = next_us;
    }
    const bool is_full = seen.clipped > kMostClipped;
    return Error{ErrorKind::kBadData, is_full ? "cloth is too bright" : "cloth is too dark",
                 fmt::format("LED {}", led),
                 fmt::format("at {} its brightest photosites come to {:.3f} of white",
                             exposure_words(exposure_us_), seen.bright),
                 is_full ? "lower the LEDs' current or close the aperture and calibrate again"
                         : "check that the LED lights and the lens is open, or say an exposure"};
  }

  /// Speaks where one exposure uses the range poorly: highlights that a few photosites see hold it down.
  void judge_range(const MeteredShot& brightest, Metering& metering) const {
    const double bright = brightest.seen.bright * metering.exposure_us / brightest.exposure_us;
    if (bright >= kPoorRange) return;
    const double times = std::min(std::round(kMeteredTo / bright), kLongestBracket);
    metering.warnings.push_back(
        fmt::format("highlights hold the exposure at {}, where 99.9 percent of the cloth stay below {:.0f} "
                    "percent of the range; scan with a bracket of {:.0f} times for the rest",
                    exposure_words(metering.exposure_us), 100 * bright, times));
  }

  const MeterInput& input_;
  const TestShot& shoot_;
  double longest_us_;  ///< a LED that is dead must not cost half a minute a test shot
  double exposure_us_;
  std::vector<MeteredShot> shots_;
};

}  // namespace

bool MeteredShot::is_full() const {
  return seen.clipped > kMostClipped || seen.brightest > kReadableTo;
}

bool MeteredShot::is_readable() const {
  return !is_full() && seen.bright >= kReadableFrom;
}

double MeteredShot::next_us() const {
  if (is_readable()) return longest_us();
  const double step =
      is_full() ? kStepDown : std::min(kMostStepUp, 0.5 * kMeteredTo / std::max(seen.brightest, 1e-4));
  return step * exposure_us;
}

double MeteredShot::longest_us() const {
  return exposure_us * std::min(kMeteredTo / seen.bright, kMeteredBelow / std::max(seen.brightest, 1e-9));
}

Json to_json(const Metering& metering) {
  Json shots = Json::array();
  for (const MeteredShot& shot : metering.test_shots) shots.push_back(to_json(shot));
  return {{"led", metering.led}, {"wanted_us", metering.wanted_us}, {"test_shots", std::move(shots)}};
}

MeterInput meter_input(std::vector<int> leds, std::vector<double> shutter_times_us,
                       const std::optional<PatchLights>& lights, double iso) {
  MeterInput input = {std::move(leds), {}, std::move(shutter_times_us), kStart_us};
  if (lights) expect_light(input, *lights, iso);
  return input;
}

Result<Metering> meter(const MeterInput& input, const TestShot& shoot) {
  return Meter(input, shoot).run();
}

std::optional<double> metered_by(const MeteredShot& shot, const MeterInput& input) {
  if (!shot.is_readable()) return std::nullopt;
  double wanted_us = shot.longest_us();
  const auto led = std::ranges::find(input.leds, shot.led) - input.leds.begin();
  if (static_cast<std::size_t>(led) < input.expected.size())
    wanted_us *= input.expected[static_cast<std::size_t>(led)] / *std::ranges::max_element(input.expected);
  return longest_below(input.shutter_times_us, wanted_us);
}

}  // namespace weft::capture
