// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "solve/conditions/bad_photosites.h"
#include "solve/conditions/brackets.h"
#include "solve/conditions/conditions.h"
#include "solve/conditions/drift.h"
#include "solve/conditions/useless_lights.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

using testing::ElementsAre;

constexpr Size kShotSize = {64, 48};

Photographs numbered(Photographs photographs) {
  photographs.leds.resize(photographs.count());
  std::iota(photographs.leds.begin(), photographs.leds.end(), 1);
  return photographs;
}

// Photograph k as if its light were so many times as bright.
void brighten(Photographs& photographs, std::size_t k, double factor) {
  Image<std::uint16_t>& counts = photographs.mosaics()->frames[k].counts;
  for (int y = 0; y < kShotSize.height; ++y) {
    for (int x = 0; x < kShotSize.width; ++x) {
      counts(x, y) = static_cast<std::uint16_t>(std::lround(kBlack + factor * (counts(x, y) - kBlack)));
    }
  }
}

TEST(BadPhotosites, AreTheDeadTheHotAndTheKnown) {
  Photographs photographs = mosaics(kShotSize, {});
  Mosaics& all = *photographs.mosaics();
  for (RawFrame& frame : all.frames) frame.counts(20, 10) = kBlack;
  RawFrame dark = frame_of(kShotSize, [](int, int) { return 0.0; });
  dark.counts(31, 7) = 20000;
  all.dark = std::move(dark);
  EXPECT_THAT(find_bad_photosites(all, {{5, 9}, {10, 20}}, 2),
              ElementsAre(Photosite{5, 9}, Photosite{7, 31}, Photosite{10, 20}));
}

TEST(BadPhotosites, GetWhatTheirNeighboursSayInEveryFrame) {
  Photographs photographs = mosaics(kShotSize, {});
  Mosaics& all = *photographs.mosaics();
  RawFrame repeat = frame_of(kShotSize, [](int, int) { return 0.25; });
  repeat.counts(20, 10) = all.frames[2].counts(20, 10) = kBlack;
  replace_bad_photosites({{10, 20}}, all, {&repeat}, 1);
  EXPECT_EQ(all.frames[2].counts(20, 10), all.frames[2].counts(22, 10));
  EXPECT_EQ(repeat.counts(20, 10), kBlack + 0.25 * kRange);
  EXPECT_THAT(all.replaced, ElementsAre(Photosite{10, 20}));
}

TEST(Brackets, GiveAllReadingsTheNoiseOfTheShortest) {
  Photographs photographs = mosaics(kShotSize, {});
  Mosaics& all = *photographs.mosaics();
  const NoiseModel before = all.noise;
  std::vector<BracketShot> shots;
  shots.push_back({.light = 3, .ratio = 0.25, .frame = frame_of(kShotSize, [](int, int) { return 0.2; })});
  shots.push_back({.light = 3, .ratio = 2, .frame = frame_of(kShotSize, [](int, int) { return 0.9; })});
  join_brackets(std::move(shots), all);
  EXPECT_DOUBLE_EQ(all.noise.per_reading, 4 * before.per_reading);
  EXPECT_DOUBLE_EQ(all.noise.floor, 16 * before.floor);
  ASSERT_EQ(all.brackets.size(), 10U);
  EXPECT_EQ(all.brackets[3].size(), 2U);
  EXPECT_TRUE(all.brackets[2].empty());
  EXPECT_NEAR(all.brackets[3][0].radiometry.noise().per_reading, 4 * before.per_reading,
              1e-6 * before.per_reading);
}

TEST(Brackets, ThatAreNoneChangeNothing) {
  Photographs photographs = mosaics(kShotSize, {});
  const NoiseModel before = photographs.mosaics()->noise;
  join_brackets({}, *photographs.mosaics());
  EXPECT_TRUE(photographs.mosaics()->brackets.empty());
  EXPECT_EQ(photographs.mosaics()->noise.per_reading, before.per_reading);
}

TEST(UselessLights, AreThoseThatAreFullAndThoseThatDidNotLight) {
  Photographs photographs = numbered(mosaics(kShotSize, {}));
  Mosaics& all = *photographs.mosaics();
  all.frames[2] = frame_of(kShotSize, [](int, int) { return 1.0; });
  brighten(photographs, 8, 0.005);
  const auto useless = find_useless_lights(photographs);
  ASSERT_EQ(useless.size(), 2U);
  EXPECT_EQ(useless[0].light, 2U);
  EXPECT_EQ(useless[0].why, UselessLight::Why::kSaturated);
  EXPECT_EQ(useless[0].full_share, 1);
  EXPECT_EQ(useless[1].light, 8U);
  EXPECT_EQ(useless[1].why, UselessLight::Why::kNotLit);

  const Vec3 ninth = photographs.field->at(9, 1, 0, 0).direction;
  ASSERT_TRUE(leave_out(std::array<std::size_t, 2>{2, 8}, photographs));
  EXPECT_EQ(photographs.count(), 8U);
  EXPECT_THAT(photographs.leds, ElementsAre(1, 2, 4, 5, 6, 7, 8, 10));
  ASSERT_EQ(photographs.field->count(), 8U);
  EXPECT_EQ(photographs.field->at(7, 1, 0, 0).direction, ninth);
  EXPECT_TRUE(find_useless_lights(photographs).empty());
}

TEST(UselessLights, AreNoneOfADimmedRing) {
  Photographs photographs = mosaics(kShotSize, {});
  for (std::size_t k = 4; k < 10; ++k) brighten(photographs, k, 0.02);
  EXPECT_TRUE(find_useless_lights(photographs).empty());
}

TEST(UselessLights, AreNoneWhereEveryFrameIsDark) {
  Photographs photographs = mosaics(kShotSize, {.albedo = {0, 0, 0}});
  EXPECT_TRUE(find_useless_lights(photographs).empty()) << "none looks darker than the others";
}

const WhitePatch kPatch = {{{8, 8}, {40, 8}, {40, 40}, {8, 40}}, {0.5, 0.5, 0.5}};

TEST(Drift, OfEachLightIsWhatAWhitePatchGives) {
  Photographs photographs = mosaics(kShotSize, {});
  for (std::size_t k = 0; k < 10; ++k) brighten(photographs, k, 1 + 0.01 * static_cast<double>(k));
  const Drift drift = find_drift(photographs, {.patches = {kPatch}}, 2);
  EXPECT_EQ(drift.source, Drift::Source::kPatches);
  ASSERT_EQ(drift.measured.size(), 10U);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_NEAR(drift.measured[k], 1 + 0.01 * static_cast<double>(k), 1e-4) << "light " << k;
  }
  ASSERT_TRUE(follow(drift, photographs));
  EXPECT_NEAR(photographs.field->at(9, 1, 0, 0).strength, 1.09, 1e-4);
}

// Four patches of the cloth itself.
std::vector<WhitePatch> four_patches() {
  std::vector<WhitePatch> patches;
  for (const double y : {2.0, 26.0}) {
    for (const double x : {2.0, 34.0})
      patches.push_back({{{x, y}, {x + 24, y}, {x + 24, y + 18}, {x, y + 18}}, {0.5, 0.5, 0.5}});
  }
  return patches;
}

// The lower left quarter of photograph k, where the third patch lies.
void shade(Photographs& photographs, std::size_t k, double factor) {
  Image<std::uint16_t>& counts = photographs.mosaics()->frames[k].counts;
  for (int y = 24; y < kShotSize.height; ++y) {
    for (int x = 0; x < 32; ++x)
      counts(x, y) = static_cast<std::uint16_t>(std::lround(kBlack + factor * (counts(x, y) - kBlack)));
  }
}

TEST(Drift, IsTheMedianOfPatchesOneOfWhichIsShadedUnderALight) {
  Photographs photographs = mosaics(kShotSize, {});
  brighten(photographs, 7, 1.02);
  shade(photographs, 7, 0.4);
  const Drift drift = find_drift(photographs, {.patches = four_patches()}, 1);
  EXPECT_NEAR(drift.measured[7], 1.02, 1e-3);
  EXPECT_NEAR(drift.measured[3], 1, 1e-3);
  ASSERT_EQ(drift.departures.size(), 1U);
  EXPECT_EQ(drift.departures[0].patch, 2U);
  EXPECT_EQ(drift.departures[0].light, 7U);
  EXPECT_NEAR(drift.departures[0].ratio, 0.4, 1e-3);
}

TEST(Drift, IsNotThatOfAPatchThatIsCoveredUnderAllLights) {
  Photographs photographs = mosaics(kShotSize, {});
  for (std::size_t k = 0; k < 10; ++k) shade(photographs, k, 0.1);
  const Drift drift = find_drift(photographs, {.patches = four_patches()}, 1);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_NEAR(drift.measured[k], 1, 1e-3) << "light " << k;
  ASSERT_EQ(drift.departures.size(), 10U);
  for (const PatchDeparture& each : drift.departures) EXPECT_EQ(each.patch, 2U);
}

TEST(Drift, BeyondAFifthIsMeasuredAndNotFollowed) {
  Photographs photographs = mosaics(kShotSize, {});
  brighten(photographs, 4, 0.5);
  const Drift drift = find_drift(photographs, {.patches = {kPatch}}, 1);
  EXPECT_NEAR(drift.measured[4], 0.5, 1e-4);
  EXPECT_EQ(drift.factor(4), 1);
  ASSERT_TRUE(follow(drift, photographs));
  EXPECT_EQ(photographs.field->at(4, 1, 0, 0).strength, 1);
}

// Lights lit a minute apart that gain 1 percent of their light a minute, light 2 once more at the end.
DriftEvidence repeated(Photographs& photographs, double ratio) {
  DriftEvidence evidence;
  for (std::size_t k = 0; k < 10; ++k) {
    evidence.times.push_back(static_cast<double>(k));
    brighten(photographs, k, 1 + 0.01 * static_cast<double>(k));
  }
  std::vector<RawFrame> again;
  const double first = 0.5 * std::cos(radians(35)) * 1.02;
  again.push_back(frame_of(kShotSize, [&](int, int) { return first * ratio; }));
  evidence.again = photographs.mosaics()->alike(std::move(again));
  evidence.repeats = {{.light = 2, .frame = 0, .earlier_time = 2, .later_time = 12}};
  return evidence;
}

TEST(Drift, OfAllLightsIsTheLineThroughARepeat) {
  Photographs photographs = mosaics(kShotSize, {});
  const Drift drift = find_drift(photographs, repeated(photographs, 1.1), 2);
  EXPECT_EQ(drift.source, Drift::Source::kRepeats);
  ASSERT_EQ(drift.ratios.size(), 1U);
  EXPECT_NEAR(*drift.ratios[0], 1.1, 1e-3);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_NEAR(drift.measured[k], 1 + 0.01 * static_cast<double>(k), 1e-3) << "light " << k;
  }
}

TEST(Drift, IsNotToldByARepeatOfACoveredLight) {
  Photographs photographs = mosaics(kShotSize, {});
  const Drift drift = find_drift(photographs, repeated(photographs, 0.5), 1);
  EXPECT_EQ(drift.source, Drift::Source::kNone);
  EXPECT_NEAR(*drift.ratios[0], 0.5, 1e-3);
  EXPECT_TRUE(drift.measured.empty());
  ASSERT_TRUE(follow(drift, photographs));
  EXPECT_EQ(photographs.field->at(2, 1, 0, 0).strength, 1);
}

TEST(Drift, IsNotAskedOfPatchesHalfOfWhichContradictTheOthers) {
  Photographs photographs = mosaics(kShotSize, {});
  DriftEvidence evidence = repeated(photographs, 1.1);
  evidence.patches = four_patches();
  for (std::size_t k = 0; k < 10; ++k) shade(photographs, k, 0.8);
  evidence.patches[1].reflectance_rgb.fill(0.6);
  const Drift drift = find_drift(photographs, evidence, 1);
  EXPECT_EQ(drift.misplaced, 2U);
  EXPECT_TRUE(drift.departures.empty());
  EXPECT_EQ(drift.source, Drift::Source::kRepeats);
}

TEST(Drift, IsAskedOfRepeatsWhereNoPatchCanBeRead) {
  Photographs photographs = mosaics(kShotSize, {});
  DriftEvidence evidence = repeated(photographs, 1.1);
  evidence.patches = {{{{100, 100}, {120, 100}, {120, 120}}, {0.5, 0.5, 0.5}}};
  const Drift drift = find_drift(photographs, evidence, 1);
  EXPECT_EQ(drift.unread_light, 0U);
  EXPECT_EQ(drift.source, Drift::Source::kRepeats);
}

// All lights of the photographs, lit once each.
solve::SolvePlan plan_of(const Photographs& photographs) {
  solve::SolvePlan plan;
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    Shot shot;
    shot.index = static_cast<int>(k);
    shot.led = shot.index + 1;
    plan.lit.push_back(shot);
  }
  return plan;
}

TEST(Conditions, ArePutRightAndToldInThePhotographs) {
  Photographs photographs = numbered(mosaics(kShotSize, {}));
  photographs.mosaics()->frames[2] = frame_of(kShotSize, [](int, int) { return 1.0; });
  brighten(photographs, 8, 0.005);
  shade(photographs, 7, 0.4);
  solve::SolvePlan plan = plan_of(photographs);
  plan.calibration.patches = four_patches();
  FramesBeside beside;
  beside.repeats = photographs.mosaics()->alike({});
  beside.known_bad = {{10, 20}};
  const JobContext context = {.threads = 1};
  const Result<void> met = meet_conditions({plan, beside, photographs, context});
  ASSERT_TRUE(met) << met.error().message();

  EXPECT_THAT(photographs.leds, ElementsAre(1, 2, 4, 5, 6, 7, 8, 10));
  EXPECT_THAT(photographs.mosaics()->replaced, ElementsAre(Photosite{10, 20}));
  const auto& [facts, warnings, of_frames, doubts, assumed, seconds] = photographs.conditions;
  EXPECT_EQ(facts.hot_photosites, 1);
  EXPECT_FALSE(facts.veil);
  ASSERT_EQ(facts.left_out.size(), 2U);
  EXPECT_EQ(facts.left_out[0].why, "saturated");
  EXPECT_EQ(facts.left_out[1].why, "not lit");
  ASSERT_EQ(facts.drift.size(), 8U);
  EXPECT_EQ(facts.drift[6].led, 8);
  EXPECT_EQ(facts.drift[6].from, "patches");
  EXPECT_FALSE(facts.cloth_gains) << "patches have told";
  EXPECT_THAT(
      warnings,
      ElementsAre("LED 3 saturated 100 percent of the frame; it was left out",
                  "LED 9 did not light the cloth: its frame looks like the dark shot; it was left out",
                  testing::HasSubstr("white patch 3 gives 0.4 times the light that most patches give under "
                                     "LED 8")));
  EXPECT_TRUE(of_frames.empty());
  EXPECT_EQ(seconds, 0) << "their caller holds the watch";
  EXPECT_TRUE(doubts.empty());
  EXPECT_TRUE(assumed.empty());
}

// What is seen of light that rises and falls along rows, of which a third leaves a pixel or two away.
constexpr solver::ClothSpread kSpread = {0.3, 0.4};
constexpr double kPixel_mm = 0.1;
double fallen(int x) {
  return 1 + 0.5 * std::cos(std::numbers::pi * 4 * (x + 0.5) / kShotSize.width);
}
double seen_of_spread(int x) {
  const double t = 4 * kSpread.mean_mm / kPixel_mm * 4 / (2.0 * kShotSize.width);  // 2 pi l f
  return 1 + (1 - kSpread.share + kSpread.share / (1 + t * t)) * (fallen(x) - 1);
}

TEST(Conditions, LightThatSpreadsInTheClothIsTakenOff) {
  Photographs raw = mosaics(kShotSize, {}), shown = developed(kShotSize, {});
  for (std::size_t k = 0; k < raw.count(); ++k) {
    raw.mosaics()->frames[k] = frame_of(kShotSize, [](int x, int) { return 0.4 * seen_of_spread(x); });
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < kShotSize.height; ++y) {
        for (int x = 0; x < kShotSize.width; ++x)
          std::get<Developed>(shown.frames).rgb[k](x, y, c) = static_cast<float>(seen_of_spread(x));
      }
    }
  }
  const double floor = raw.mosaics()->noise.floor;
  for (Photographs* photographs : {&raw, &shown}) {
    photographs->camera.reset();
    solve::SolvePlan plan = plan_of(*photographs);
    plan.is_of_rig = photographs == &raw;
    plan.cloth_spread = kSpread;
    FramesBeside beside;
    if (photographs == &raw) beside.repeats = raw.mosaics()->alike({});
    const JobContext context = {.threads = 1};
    const Result<void> unknown = meet_conditions({plan, beside, *photographs, context});
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
    plan.input.mm_per_pixel = kPixel_mm;
    const Result<void> met = meet_conditions({plan, beside, *photographs, context});
    ASSERT_TRUE(met) << met.error().message();
    ASSERT_TRUE(photographs->conditions.facts.cloth_spread);
    Image<float> scratch({kShotSize.width, 2});
    const auto rows = readings_of(photographs->frames, 3, {0, 20, kShotSize.width, 22}, scratch.plane());
    const float* row = rows.front().row(0);
    const double unit = static_cast<double>(row[8]) / fallen(8);
    for (int x = 0; x < kShotSize.width; ++x)
      EXPECT_NEAR(static_cast<double>(row[x]) / unit, fallen(x), 0.02) << "column " << x;
  }
  EXPECT_NEAR(raw.mosaics()->noise.floor, floor / 0.49, 1e-9 * floor);
}

TEST(Conditions, LightThatSpreadsWithinAPixelIsLeft) {
  Photographs photographs = developed(kShotSize, {});
  photographs.camera.reset();
  solve::SolvePlan plan = plan_of(photographs);
  plan.is_of_rig = false;
  plan.cloth_spread = {0.3, 0.001};
  plan.input.mm_per_pixel = kPixel_mm;
  FramesBeside beside;
  const JobContext context = {.threads = 1};
  ASSERT_TRUE(meet_conditions({plan, beside, photographs, context}));
  EXPECT_FALSE(photographs.conditions.facts.cloth_spread);
  EXPECT_THAT(photographs.conditions.warnings, ElementsAre(testing::HasSubstr("it is left as it is")));
}

TEST(Conditions, OfPhotographsWithoutARigLeaveNoLightOut) {
  Photographs photographs = developed(kShotSize, {});
  for (int c = 0; c < 3; ++c) {
    const View<float> plane = std::get<Developed>(photographs.frames).rgb[2].plane(c);
    for (int y = 0; y < kShotSize.height; ++y)
      std::fill_n(plane.row(y), kShotSize.width, std::numeric_limits<float>::infinity());
  }
  ASSERT_EQ(find_useless_lights(photographs).size(), 1U);
  solve::SolvePlan plan = plan_of(photographs);
  plan.is_of_rig = false;
  FramesBeside beside;
  const JobContext context = {.threads = 1};
  ASSERT_TRUE(meet_conditions({plan, beside, photographs, context}));
  EXPECT_EQ(photographs.count(), 10U);
  EXPECT_THAT(photographs.conditions.warnings, testing::IsEmpty());
  EXPECT_TRUE(photographs.conditions.facts.left_out.empty());
}

}  // namespace
}  // namespace weft::solve
