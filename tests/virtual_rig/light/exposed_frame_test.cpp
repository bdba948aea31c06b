// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/exposed_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <span>
#include <string>

#include "capture/raw/decode_raw.h"
#include "capture/raw/tiff_tags.h"
#include "core/base/files.h"
#include "simulator/camera/saturation.h"
#include "simulator/simulate.h"
#include "tests/virtual_rig/small_scene.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;
using simulator::Scene;
using std::chrono::microseconds;
using testing::ElementsAre;

LightFrames opened(const Scene& scene, const std::string& name = "cache") {
  Result<LightFrames> frames = LightFrames::open(scene, fresh_folder() / name);
  if (!frames) throw std::runtime_error(frames.error().message());
  return std::move(*frames);
}

/// An exposure as the scene has it.
CameraExposure exposure_of(const LightFrames& frames, std::uint32_t image_number = 103) {
  CameraExposure exposure;
  exposure.exposure_us = frames.rig().exposure_us;
  exposure.iso = frames.scene().camera.iso;
  exposure.f_number = frames.scene().camera.f_number;
  exposure.image_number = image_number;
  exposure.date_time = "2026:01:31 23:59:58";
  exposure.milliseconds = 7;
  return exposure;
}

GatheredLight gathered(const LightFrames& frames, const std::vector<double>& pins,
                       const LightFaults& faults = {}, std::uint32_t image_number = 103) {
  return gathered_light(frames, pins, faults, exposure_of(frames, image_number));
}

double mean_of(const Image<std::uint16_t>& counts) {
  double sum = 0;
  for (int y = 0; y < counts.height(); ++y)
    for (int x = 0; x < counts.width(); ++x) sum += counts(x, y);
  return sum / static_cast<double>(counts.size().pixels());
}

/// Photosites of `a` and `b` that differ, and the largest difference.
struct Difference {
  int photosites = 0;
  int most = 0;
};
Difference difference_of(const Image<std::uint16_t>& a, const Image<std::uint16_t>& b, int border = 0) {
  Difference difference;
  EXPECT_EQ(a.size(), b.size());
  for (int y = border; y < a.height() - border; ++y) {
    for (int x = 0; x < a.width(); ++x) {
      difference.photosites += a(x, y) != b(x, y) ? 1 : 0;
      difference.most = std::max(difference.most, std::abs(a(x, y) - b(x, y)));
    }
  }
  return difference;
}

/// What the simulator itself photographs; its noise is that of the take `image_number`.
Image<std::uint16_t> simulated(const Scene& scene, const std::vector<int>& leds, int image_number) {
  const fs::path file = fresh_folder() / "simulated.dng";
  simulator::SimulateOptions options;
  options.takes_before = image_number - (leds.empty() ? 0 : leds.front());
  const Result<void> done = simulate_photograph(scene, {leds, {}}, file, options);
  if (!done) throw std::runtime_error(done.error().message());
  Result<RawFrame> frame = capture::decode_raw(file);
  if (!frame) throw std::runtime_error(frame.error().message());
  return std::move(frame->counts);
}

TEST(Exposure, OfOneLedIsTheFrameThatTheSimulatorMakesOfIt) {
  const LightFrames frames = opened(small_scene());
  const Difference difference =
      difference_of(read_out(frames, gathered(frames, {0, 0, 1})), simulated(small_scene(), {3}, 103));
  // Planes are floats and the simulator's signal is not: a rounding may fall the other way.
  EXPECT_LE(difference.photosites, 128 * 96 / 1000);
  EXPECT_LE(difference.most, 1) << "an electron is 0.4 counts";
}

TEST(Exposure, WithEverythingThatASensorDoesIsTheSimulatorsFrame) {
  Scene scene = small_scene();
  scene.camera.exposure_us = 60000;
  scene.camera.bits = 12;
  scene.effects.bloom = scene.effects.dark_current = scene.effects.uneven_response = true;
  scene.effects.nonlinearity = scene.effects.ambient = true;
  scene.camera.defects.hot_per_million = 2000;
  scene.camera.defects.dark_electrons_per_s = 300;
  scene.camera.defects.cell_counts = {{{5, 6}, {7, 8}}};
  const LightFrames frames = opened(scene);
  const Image<std::uint16_t> counts = read_out(frames, gathered(frames, {0, 1, 0}));
  const int border = bloom_kernel(scene.camera.bloom).radius();  // where blooming from outside is not known
  const Difference difference = difference_of(counts, simulated(scene, {2}, 103), border);
  EXPECT_LE(difference.photosites, 128 * 96 / 500);
  EXPECT_LE(difference.most, 1);
  int full = 0;
  for (int x = 0; x < 128; ++x) full += counts(x, 48) == 3961 ? 1 : 0;
  EXPECT_GT(full, 0) << "nothing bloomed";
}

TEST(Exposure, HasTheSignalOfItsLedsWithinTheRoundingOfAFloat) {
  Scene scene = small_scene();
  const LightFrames frames = opened(scene);
  scene.effects.noise = false;
  const simulator::Rendering truth = render_readings(scene, {0, 0, 128, 96}).value();
  const Image<double> signal = signal_of(frames, gathered(frames, {0, 0, 1}));
  const double exposure = frames.rig().exposure(scene.camera.iso);
  constexpr CfaPattern kCfa;
  double worst = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 128; ++x) {
      const double wanted = exposure * truth.readings(x, y, 6 + kCfa.channel_at(x, y));
      worst = std::max(worst, std::abs(signal(x, y) - wanted) / wanted);
    }
  }
  EXPECT_LT(worst, 1e-7);
}

TEST(Exposure, GathersHalfTheLightOfAPinThatWasOnForHalfOfIt) {
  const LightFrames frames = opened(small_scene());
  const Image<double> whole = signal_of(frames, gathered(frames, {0, 0, 1}));
  const Image<double> half = signal_of(frames, gathered(frames, {0, 0, 0.5}));
  EXPECT_DOUBLE_EQ(half(64, 48), whole(64, 48) / 2);
}

TEST(Exposure, OfTwoLedsIsTheSumOfTheirLight) {
  const LightFrames frames = opened(small_scene());
  const Image<double> first = signal_of(frames, gathered(frames, {1, 0, 0}));
  const Image<double> third = signal_of(frames, gathered(frames, {0, 0, 1}));
  const Image<double> both = signal_of(frames, gathered(frames, {1, 0, 1}));
  EXPECT_DOUBLE_EQ(both(64, 48), first(64, 48) + third(64, 48));
}

TEST(Exposure, InTheDarkHoldsTheBlackLevelAndReadNoise) {
  Scene scene = small_scene();
  scene.camera.body = simulator::Body::kOffset;
  const LightFrames frames = opened(scene);
  const Image<std::uint16_t> dark = read_out(frames, gathered(frames, {0, 0, 0}));
  const double epc = frames.rig().sensor.electrons_per_count();
  double variance = 0;
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 128; ++x) variance += (dark(x, y) - 600.0) * (dark(x, y) - 600.0) / (128 * 96);
  EXPECT_NEAR(mean_of(dark), 600, 0.1);
  EXPECT_NEAR(variance, 9 / (epc * epc) + 1.0 / 12, 0.05) << "3 electrons of read noise";
}

TEST(Exposure, OfTooMuchLightIsWhite) {
  const LightFrames frames = opened(small_scene());
  CameraExposure exposure = exposure_of(frames);
  exposure.exposure_us *= 1000;
  const Image<std::uint16_t> counts = read_out(frames, gathered_light(frames, {1, 1, 1}, {}, exposure));
  EXPECT_EQ(mean_of(counts), 15846);
}

TEST(Exposure, DrawsPhotonsAsOftenAsTheyCome) {
  const LightFrames frames = opened(small_scene());
  const simulator::Sensor& sensor = frames.rig().sensor;
  const Image<std::uint16_t> a = read_out(frames, gathered(frames, {1, 0, 0}, {}, 1));
  const Image<std::uint16_t> b = read_out(frames, gathered(frames, {1, 0, 0}, {}, 2));
  const Image<double> signal = signal_of(frames, gathered(frames, {1, 0, 0}));
  double measured = 0, expected = 0, bias = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 128; ++x) {
      const double difference = a(x, y) - b(x, y);
      const double counts = signal(x, y) * (sensor.white - sensor.black);
      measured += difference * difference / 2;
      expected += counts / sensor.electrons_per_count() +
                  9 / (sensor.electrons_per_count() * sensor.electrons_per_count()) + 1.0 / 12;
      bias += (a(x, y) + b(x, y)) / 2.0 - sensor.black - counts;
    }
  }
  EXPECT_NEAR(measured / expected, 1, 5 * std::sqrt(2.0 / (128 * 96))) << "of the variance";
  EXPECT_LT(std::abs(bias), 5 * std::sqrt(expected / 2)) << "of the sum";
}

TEST(Exposure, HasTheSameBytesForTheSameNumberAndAnyThreads) {
  const LightFrames frames = opened(small_scene(600));
  const auto bytes = [&](std::uint32_t number, int threads) {
    return develop(frames, gathered(frames, {0, 1, 0}, {}, number), exposure_of(frames, number), "1", threads)
        .value();
  };
  EXPECT_EQ(bytes(7, 1), bytes(7, 3));
  EXPECT_NE(bytes(7, 1), bytes(8, 1));
}

TEST(Exposure, CountsAPinThatWasOnThroughoutAsTheWholeOfItToTheLastBit) {
  const LightFrames frames = opened(small_scene());
  LitLog pins;
  const RigClock::time_point start{microseconds(1234567)};
  pins.record(start, 0b001);
  for (int edge = 1; edge < 50; ++edge)
    pins.record(start + microseconds(137 * edge), edge % 2 == 0 ? 0b001 : 0b101);
  for (const int late_us : {0, 1, 333}) {  // whatever the shutter's thread is late by
    const std::vector<double> shares =
        lit_shares(pins, start + microseconds(11), start + microseconds(6000 + late_us), 3);
    EXPECT_EQ(shares[0], 1);
    EXPECT_EQ(shares[1], 0);
    EXPECT_EQ(gathered(frames, shares).leds_s[0], frames.rig().exposure_us * 1e-6);
  }
}

TEST(Exposure, CountsAPinByTheShareOfTheTimeThatItWasOn) {
  LitLog pins;
  const RigClock::time_point start{microseconds(5000000)};
  pins.record(start + microseconds(250), 0b010);
  pins.record(start + microseconds(750), 0);
  EXPECT_THAT(lit_shares(pins, start, start + microseconds(1000), 3),
              ElementsAre(0, testing::DoubleNear(0.5, 1e-9), 0));
  EXPECT_THAT(lit_shares(pins, start, start, 3), ElementsAre(0, 0, 0)) << "a shutter that never opened";
}

TEST(Exposure, FollowsTheCamerasSettings) {
  Scene scene = small_scene();
  scene.camera.retakes.shutter_error = 0.1;
  const LightFrames frames = opened(scene);
  CameraExposure exposure = exposure_of(frames);
  const auto brightness = [&] {
    return signal_of(frames, gathered_light(frames, {0, 0, 1}, {}, exposure))(64, 48);
  };
  const double plain = brightness();
  exposure.iso *= 4;
  EXPECT_DOUBLE_EQ(brightness(), 4 * plain);
  exposure.iso /= 4;
  exposure.f_number *= 2;
  EXPECT_DOUBLE_EQ(brightness(), plain / 4);
  exposure.f_number /= 2;
  exposure.exposure_us *= 2;
  EXPECT_DOUBLE_EQ(brightness(), 2 * 1.1 * plain) << "its shutter is not exact away from the scene's time";
}

TEST(Exposure, ShowsFaultsOfLight) {
  const LightFrames frames = opened(small_scene());
  const auto signal = [&](const LightFaults& faults) {
    return signal_of(frames, gathered(frames, {0, 0, 1}, faults));
  };
  const Image<double> plain = signal({});
  LightFaults ambient;
  ambient.ambient = 0.5;
  const double exposure = frames.rig().exposure(100);
  EXPECT_NEAR(signal(ambient)(64, 48),
              plain(64, 48) + 0.5 * exposure * static_cast<double>(frames.ambient()(64, 48)), 1e-12);
  LightFaults moved;
  moved.move_x = 6;
  moved.move_y = -4;
  const Image<double> away = signal(moved);
  EXPECT_EQ(away(70, 44), plain(64, 48));
  EXPECT_EQ(away(3, 50), plain(1, 54)) << "beyond the border the outermost filter cell goes on";
  EXPECT_EQ(away(70, 95), plain(64, 95));
  EXPECT_EQ(away(70, 93), plain(64, 95));
  LightFaults flicker;
  flicker.flicker = 0.1;
  const double one = gathered(frames, {0, 0, 1}, flicker, 1).leds_s[2];
  EXPECT_NE(one, gathered(frames, {0, 0, 1}, flicker, 2).leds_s[2]);
  EXPECT_EQ(one, gathered(frames, {0, 0, 1}, flicker, 1).leds_s[2]);
}

TEST(Exposure, GivesEachRowTheLightOfItsOwnTime) {
  const LightFrames frames = opened(small_scene());
  CameraExposure exposure = exposure_of(frames);
  exposure.opened = RigClock::time_point(microseconds(123456));
  exposure.readout_s = 0.02;
  LightFaults faults;
  faults.ambient = 0.5;
  const auto signal = [&](const std::vector<double>& pins) {
    return signal_of(frames, gathered_light(frames, pins, faults, exposure));
  };
  const Image<double> lit = signal({0, 0, 1}), dark = signal({0, 0, 0});
  faults.pulses = LightWave{500, 1, 0.5};
  faults.lamp = LightWave{100, 0.4, {}};
  const Image<double> flickers = signal({0, 0, 1});
  const double exposure_s = exposure.exposure_us * 1e-6;
  for (int y = 0; y < 96; ++y) {
    const double from_s = 0.123456 + 0.02 * y / 95;
    const double by_led = mean_light(*faults.pulses, from_s, exposure_s);
    const double by_lamp = mean_light(*faults.lamp, from_s, exposure_s);
    EXPECT_NEAR(flickers(64, y), by_led * (lit(64, y) - dark(64, y)) + by_lamp * dark(64, y), 1e-9) << y;
  }
  EXPECT_GT(mean_light(*faults.pulses, 0.1235, exposure_s), 0);
}

TEST(Exposure, OfWholePeriodsIsThatOfSteadyLight) {
  const LightFrames frames = opened(small_scene());
  CameraExposure exposure = exposure_of(frames);
  exposure.opened = RigClock::time_point(microseconds(98765));
  exposure.readout_s = 0.02;
  exposure.exposure_us = 20000;
  LightFaults faults;
  const Image<double> steady = signal_of(frames, gathered_light(frames, {0, 0, 1}, faults, exposure));
  faults.pulses = LightWave{250, 1, 0.3};
  const Image<double> flickers = signal_of(frames, gathered_light(frames, {0, 0, 1}, faults, exposure));
  for (int y = 0; y < 96; ++y) EXPECT_NEAR(flickers(64, y) / steady(64, y), 1, 1e-9) << y;
}

TEST(Exposure, StopsWhereItsChannelsDo) {
  const LightFrames frames = opened(small_scene());
  CameraExposure exposure = exposure_of(frames);
  exposure.exposure_us *= 1000;
  GatheredLight light = gathered_light(frames, {1, 1, 1}, {}, exposure);
  light.stops = {15000, 14000, 0};
  const Image<std::uint16_t> counts = read_out(frames, light);
  constexpr CfaPattern kCfa;
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 128; ++x)
      ASSERT_EQ(counts(x, y),
                (std::array{15000, 14000, 15846}[static_cast<std::size_t>(kCfa.channel_at(x, y))]));
  light.stops = {15000, 15000, 15000};
  light.leds_s = {0, 0, exposure_of(frames).exposure_us * 1e-6};
  GatheredLight without = light;
  without.stops = {};
  EXPECT_EQ(difference_of(read_out(frames, light), read_out(frames, without)).photosites, 0)
      << "what is below is as it was";
}

TEST(Exposure, LosesItsDarkWhereTheBodySubtractsIt) {
  Scene scene = small_scene();
  scene.camera.body = simulator::Body::kOffset;
  scene.effects.dark_current = true;
  scene.camera.defects.hot_per_million = 2000;
  scene.camera.defects.dark_electrons_per_s = 200;
  const LightFrames frames = opened(scene);
  CameraExposure exposure = exposure_of(frames);
  exposure.exposure_us = 2e6;
  const auto decoded = [&](bool loses_its_dark) {
    exposure.loses_its_dark = loses_its_dark;
    const fs::path file = fresh_folder() / "dark.dng";
    const auto bytes =
        develop(frames, gathered_light(frames, {0, 0, 0}, {}, exposure), exposure, "1").value();
    EXPECT_TRUE(write_file(file, std::string(bytes.begin(), bytes.end())));
    return capture::decode_raw(file).value().counts;
  };
  const double per_count = frames.rig().sensor.electrons_per_count();
  const Image<std::uint16_t> plain = decoded(false), subtracted = decoded(true);
  EXPECT_GT(mean_of(plain), 600 + 0.5 * 400 / per_count) << "two seconds of warmth";
  EXPECT_NEAR(mean_of(subtracted), 600, 0.5);
  EXPECT_EQ(subtracted.size(), plain.size());
}

TEST(Exposure, FlickersAsItsSceneSays) {
  Scene scene = small_scene();
  scene.effects.led_drift = true;
  scene.lights.flicker = 0.003;
  const LightFrames frames = opened(scene);
  const double steady = gathered(opened(small_scene()), {0, 0, 1}, {}, 1).leds_s[2];
  double sum = 0, squares = 0;
  for (std::uint32_t image = 1; image <= 400; ++image) {
    const double off = gathered(frames, {0, 0, 1}, {}, image).leds_s[2] / steady - 1;
    sum += off, squares += off * off;
  }
  EXPECT_NEAR(sum / 400, 0, 3 * 0.003 / 20);
  EXPECT_NEAR(std::sqrt(squares / 400), 0.003, 0.0004);
}

/// The tags of the EXIF directory by number: type and raw bytes.
std::map<int, std::string> exif_tags(const std::vector<std::uint8_t>& bytes) {
  const auto tiff = capture::Tiff::read([&bytes](std::uint64_t offset, std::span<std::uint8_t> out) {
    if (offset + out.size() > bytes.size()) return false;
    std::memcpy(out.data(), bytes.data() + offset, out.size());
    return true;
  });
  std::map<int, std::string> tags;
  if (!tiff) return tags;
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, size);
    return value;
  };
  const std::size_t exif = static_cast<std::size_t>(*tiff->number(tiff->directories()[0], 34665));
  for (std::size_t i = 0; i < number(exif, 2); ++i) {
    const std::size_t entry = exif + 2 + 12 * i, count = number(entry + 4, 4);
    const std::size_t size = number(entry + 2, 2) == 4 ? 4 * count : count;  // LONG; else bytes of a text
    const std::size_t at = size > 4 ? number(entry + 8, 4) : entry + 8;
    tags[static_cast<int>(number(entry, 2))] =
        std::string(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  }
  return tags;
}

TEST(Exposure, IsAFileThatSaysWhatTookItAndWhen) {
  const LightFrames frames = opened(small_scene());
  const GatheredLight light = gathered(frames, {0, 0, 1}, {}, 70000);
  const std::vector<std::uint8_t> bytes =
      develop(frames, light, exposure_of(frames, 70000), "6000042").value();
  const fs::path file = fresh_folder() / "shot.dng";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const Result<RawFrame> frame = capture::decode_raw(file);
  ASSERT_TRUE(frame) << frame.error().message();
  EXPECT_EQ(frame->shot.serial, "6000042");
  EXPECT_EQ(frame->shot.model, "D5100");
  EXPECT_NEAR(frame->shot.exposure_us, frames.rig().exposure_us, 0.1);
  EXPECT_EQ(frame->shot.iso, 100);
  EXPECT_EQ(frame->shot.f_number, 8);
  EXPECT_EQ(difference_of(frame->counts, read_out(frames, light)).photosites, 0);
  std::map<int, std::string> exif = exif_tags(bytes);
  EXPECT_EQ(exif[36867], std::string("2026:01:31 23:59:58\0", 20)) << "DateTimeOriginal";
  EXPECT_EQ(exif[37521], std::string("007\0", 4)) << "SubSecTimeOriginal";
  EXPECT_EQ(exif[0x9211], std::string("\x70\x11\x01\0", 4)) << "ImageNumber";
}

// As a simulated session is made through films.
TEST(Films, ShowTheGlossAsTheSimulatorsDo) {
  Scene glossy = small_scene();
  glossy.effects.reflectance = true;
  glossy.material.reflectance = simulator::Ggx{};
  Scene through_films = glossy;
  through_films.films = {.states = simulator::FilmStates::kCrossed, .leak = 0};
  const LightFrames frames = opened(glossy), scattered = opened(through_films);
  const auto signal_in = [](const LightFrames& of, std::optional<double> crossed_share,
                            const LightFrames* matt) {
    GatheredLight light = gathered(of, {0, 1, 0});
    light.ambient_s = 0;
    light.leds_s = {0, 1e-3, 0};
    if (crossed_share) add_films(light, *crossed_share, matt);
    return signal_of(of, light)(64, 48);
  };
  const double all = signal_in(frames, std::nullopt, nullptr);
  const double matt = 4 * signal_in(scattered, std::nullopt, nullptr);
  EXPECT_GT(std::abs(all - matt), 0.001 * matt) << "the cloth has gloss";
  const auto filmed = [&](double crossed_share) { return signal_in(frames, crossed_share, &scattered); };
  EXPECT_NEAR(filmed(0), matt / 4 + (all - matt) / 2, 1e-6 * all) << "parallel";
  EXPECT_NEAR(filmed(1), matt / 4 + 0.01 * (all - matt) / 2, 1e-6 * all) << "crossed";
  through_films.films = {.states = simulator::FilmStates::kParallel};
  EXPECT_NEAR(filmed(0), signal_in(opened(through_films), std::nullopt, nullptr), 1e-6 * all);
  through_films.films = {.states = simulator::FilmStates::kCrossed};
  EXPECT_NEAR(filmed(1), signal_in(opened(through_films), std::nullopt, nullptr), 1e-6 * all);
  EXPECT_NEAR(signal_in(frames, 1, nullptr), all / 4, 1e-6 * all) << "of cloth without gloss";
}

TEST(LightBelow, ComesThroughTheClothEvenly) {
  const LightFrames frames = opened(small_scene());
  GatheredLight light = gathered(frames, {0, 0, 0});
  light.ambient_s = 0;
  CameraExposure exposure = exposure_of(frames);
  exposure.exposure_us = 2e6;
  add_light_below(light, 0.5, exposure);
  EXPECT_NEAR(signal_of(frames, light)(64, 48), 0.05 * static_cast<double>(frames.ambient()(64, 48)), 1e-9);
}

}  // namespace
}  // namespace weft::virtual_rig
