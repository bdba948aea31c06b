// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/light_evidence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "tests/capture/scan/simulated_rig.h"

namespace weft::capture {
namespace {

using test::Lighting;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kRepeat = -1;
constexpr int kDarkAgain = -2;                   // the dark shot at the end
using Story = std::function<Lighting(int led)>;  // 0: dark, kRepeat: LED 1 again

/// A session under a story of what really lit each shot; the first verdict that speaks, with its shot.
struct Told {
  ShotVerdict verdict;
  int at = -1;
  double drift = 0;  // of the repeat
  std::vector<std::string> warnings;
};

Told told(const simulator::Scene& scene, const Story& story, bool with_model = true,
          double brightness = 0.8) {
  const test::SimulatedCloth cloth(scene);
  Result<PatchLights> model = PatchLights::make(cloth.calibration(), 0);
  EXPECT_TRUE(model) << model.error().message();
  const PatchGrid grid = model->grid;
  ScanEvidence evidence(grid, with_model ? std::optional(std::move(*model)) : std::nullopt);
  const ExposureSettings exposure = {brightness * cloth.scene_exposure_us(), 100, 8};
  Told told;
  for (const DueShot& shot : plan_shots({{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, true, {}}, exposure, {})) {
    const bool is_repeat = shot.role == ShotRole::kRepeat;
    const Lighting lighting = story(!is_repeat ? shot.led : shot.led == 0 ? kDarkAgain : kRepeat);
    std::vector<double> light = evidence.glance(
        cloth.photograph(lighting, exposure.exposure_us, static_cast<std::uint32_t>(shot.index)));
    told.verdict = evidence.judge(shot, light);
    told.warnings.insert(told.warnings.end(), told.verdict.warnings.begin(), told.verdict.warnings.end());
    told.at = shot.index;
    if (told.verdict.level && is_repeat) told.drift = *told.verdict.level;
    if (told.verdict.finding != LightFinding::kAgrees) return told;
    evidence.accept(shot, std::move(light));
  }
  return told;
}

Lighting as_planned(int led) {
  if (led == 0 || led == kDarkAgain) return {};
  return {{{led == kRepeat ? 1 : led, 1.0}}, 0};
}

simulator::Scene woven() {
  simulator::Scene scene = test::small_scene();
  scene.geometry.kind = simulator::GeometryKind::kPlain;
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = 12;
  return scene;
}

TEST(LightEvidence, AgreesWithASessionAsPlanned) {
  for (const auto& scene : {test::small_scene(), woven()}) {
    const Told t = told(scene, as_planned);
    EXPECT_EQ(t.verdict.finding, LightFinding::kAgrees) << t.verdict.sentence;
    EXPECT_EQ(t.at, 12);
    EXPECT_TRUE(t.warnings.empty()) << t.warnings.front();
    EXPECT_NEAR(t.drift, 1, 0.005);
  }
}

TEST(LightEvidence, BlamesNoLightWhereFramesAreFull) {
  simulator::Scene satin = woven();
  satin.geometry.kind = simulator::GeometryKind::kSatin;
  for (const auto& scene : {woven(), satin}) {
    for (double brightness = 1; brightness < 16; brightness *= 1.25) {
      const Told t = told(scene, as_planned, true, brightness);
      EXPECT_EQ(t.verdict.finding, LightFinding::kAgrees) << brightness << " times: " << t.verdict.sentence;
    }
  }
  EXPECT_THAT(told(woven(), as_planned, true, 8).warnings, testing::Contains(HasSubstr("full photosites")));
}

/// What the evidence says of the last of these LEDs in the polariser's other state, where those lightings
/// light them instead and the frames before it were kept.
ShotVerdict other_state(const std::map<int, Lighting>& lightings) {
  const test::SimulatedCloth cloth(woven());
  Result<PatchLights> model = PatchLights::make(cloth.calibration(), 0);
  EXPECT_TRUE(model) << model.error().message();
  const PatchGrid grid = model->grid;
  ScanEvidence evidence(grid, std::move(*model), Polariser::kCrossed);
  const ExposureSettings exposure = {0.8 * cloth.scene_exposure_us(), 100, 8};
  const ShotList list = {
      {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, true, {}, {Polariser::kCrossed, Polariser::kParallel}};
  ShotVerdict verdict;
  for (const DueShot& shot : plan_shots(list, exposure, {})) {
    const bool is_other = shot.polariser == Polariser::kParallel;
    if (is_other && !lightings.contains(shot.led)) continue;
    const Lighting of_plan = shot.led == 0 ? Lighting() : Lighting{{{shot.led, 1.0}}, 0};
    std::vector<double> light =
        evidence.glance(cloth.photograph(is_other ? lightings.at(shot.led) : of_plan, exposure.exposure_us,
                                         static_cast<std::uint32_t>(shot.index)));
    verdict = evidence.judge(shot, light);
    EXPECT_TRUE(is_other || verdict.finding == LightFinding::kAgrees) << verdict.sentence;
    if (is_other && shot.led == lightings.rbegin()->first) break;
    evidence.accept(shot, std::move(light));
  }
  return verdict;
}

TEST(LightEvidence, HoldsTheOtherStateOfThePolariserAgainstTheFirst) {
  const ShotVerdict brighter = other_state({{3, {{{3, 1.2}}, 0}}});
  EXPECT_EQ(brighter.finding, LightFinding::kAgrees) << brighter.sentence;
  EXPECT_NEAR(brighter.level.value_or(0), 1.2, 0.01);
  EXPECT_EQ(other_state({{3, {}}}).finding, LightFinding::kDark);
  const ShotVerdict other = other_state({{3, {{{5, 1.0}}, 0}}});
  EXPECT_EQ(other.finding, LightFinding::kOther);
  EXPECT_THAT(other.sentence, HasSubstr("LED 5 lights where LED 3 should"));
  EXPECT_THAT(other.accused, ElementsAre(14));
}

TEST(LightEvidence, AccusesBothFramesOfSwappedLedsInTheOtherState) {
  const ShotVerdict swapped = other_state({{3, {{{5, 1.0}}, 0}}, {5, {{{3, 1.0}}, 0}}});
  EXPECT_THAT(swapped.sentence, HasSubstr("LED 3 lights where LED 5 should"));
  EXPECT_THAT(swapped.accused, ElementsAre(16, 14));
}

TEST(LightEvidence, BelievesNoFrameOfTheOtherStateWhereOneIsNotOfItsLed) {
  const ShotVerdict other =
      other_state({{2, {{{2, 1.0}}, 0}}, {3, {{{3, 1.0}}, 0}}, {4, {{{4, 1.0}}, 0}}, {6, {{{9, 1.0}}, 0}}});
  EXPECT_EQ(other.finding, LightFinding::kOther);
  EXPECT_THAT(other.accused, ElementsAre(17, 13, 14, 15)) << "a lamp may have lit them";
}

TEST(LightEvidence, SpeaksOfALightBelowThatNothingComesThroughOf) {
  const test::SimulatedCloth cloth(woven());
  ScanEvidence evidence(PatchGrid::over(cloth.calibration().camera->size), std::nullopt);
  const DueShot below = {12, 0, ShotRole::kBelow, {cloth.scene_exposure_us(), 100, 8}};
  const ShotVerdict dense = evidence.judge(below, evidence.glance(cloth.photograph({}, 1000, 1)));
  EXPECT_EQ(dense.finding, LightFinding::kAgrees) << "it is kept";
  EXPECT_EQ(dense.doubt, LightFinding::kDark);
  ASSERT_EQ(dense.warnings.size(), 1u);
  const Lighting through = {{{1, 0.5}}, 0};
  EXPECT_TRUE(evidence.judge(below, evidence.glance(cloth.photograph(through, cloth.scene_exposure_us(), 2)))
                  .warnings.empty());
}

TEST(LightEvidence, AsksAgainForABladeWhoseShadowIsNotThere) {
  simulator::Scene under_blade = woven();
  under_blade.blade = {.lies = true, .turn_deg = 240, .height_mm = 20};
  const test::SimulatedCloth cloth(woven()), bladed(under_blade);
  Result<PatchLights> model = PatchLights::make(cloth.calibration(), 0);
  ASSERT_TRUE(model) << model.error().message();
  const PatchGrid grid = model->grid;
  ScanEvidence evidence(grid, std::move(*model));
  const ExposureSettings exposure = {0.8 * cloth.scene_exposure_us(), 100, 8};
  const auto glance = [&](const test::SimulatedCloth& at, const Lighting& lighting) {
    return evidence.glance(at.photograph(lighting, exposure.exposure_us, 1));
  };
  const Lighting lit = {{{1, 1.0}}, 0};
  evidence.accept({0, 1, ShotRole::kLit, exposure}, glance(cloth, lit));
  const DueShot shot = {1, 1, ShotRole::kBlade, exposure};
  const ShotVerdict laid = evidence.judge(shot, glance(bladed, lit));
  EXPECT_EQ(laid.finding, LightFinding::kAgrees) << laid.sentence;
  const ShotVerdict not_laid = evidence.judge(shot, glance(cloth, lit));
  EXPECT_EQ(not_laid.finding, LightFinding::kChanged);
  EXPECT_TRUE(not_laid.may_pass());
  EXPECT_THAT(not_laid.sentence, HasSubstr("no shadow of a blade lies in the light of LED 1"));
  EXPECT_EQ(evidence.judge(shot, glance(bladed, {})).finding, LightFinding::kDark);
}

TEST(LightEvidence, NamesTwoSwappedLeds) {
  for (const auto& scene : {test::small_scene(), woven()}) {
    const Told t = told(scene, [](int led) { return as_planned(led == 3 ? 4 : led == 4 ? 3 : led); });
    EXPECT_EQ(t.verdict.finding, LightFinding::kOther);
    EXPECT_THAT(t.verdict.sentence, HasSubstr("LED 4 lights where LED 3 should and the other way round"));
    EXPECT_THAT(t.verdict.accused, ElementsAre(3, 4));
    EXPECT_FALSE(t.verdict.may_pass());
    EXPECT_LE(t.at, 6);
  }
}

TEST(LightEvidence, NamesALedThatLightsInThePlaceOfAnother) {
  const Told t = told(woven(), [](int led) { return as_planned(led == 6 ? 9 : led); });
  EXPECT_THAT(t.verdict.sentence, HasSubstr("LED 9 lights where LED 6 should: are their wires swapped?"));
  EXPECT_THAT(t.verdict.accused, ElementsAre(6));
}

TEST(LightEvidence, NamesADarkLedAndADimOne) {
  Told t = told(woven(), [](int led) { return led == 5 ? Lighting() : as_planned(led); });
  EXPECT_EQ(t.verdict.sentence, "LED 5 is dark");
  EXPECT_EQ(t.at, 5);
  EXPECT_TRUE(t.verdict.may_pass());
  t = told(woven(), [](int led) { return led == 5 ? Lighting{{{5, 0.25}}, 0} : as_planned(led); });
  EXPECT_EQ(t.verdict.finding, LightFinding::kDim) << t.verdict.sentence;
  t = told(woven(), [](int led) { return led == 1 ? Lighting() : as_planned(led); });
  EXPECT_EQ(t.verdict.sentence, "LED 1 is dark") << "the first one, too";
  auto scene = woven();
  scene.effects.noise = false;
  t = told(scene, [](int led) { return led == kRepeat ? Lighting() : as_planned(led); });
  EXPECT_EQ(t.verdict.sentence, "LED 1 is dark") << "as its repeat";
}

TEST(LightEvidence, NamesALedThatStaysLit) {
  const Told t = told(woven(), [](int led) {
    Lighting lighting = as_planned(led);
    if (led > 2 || led == kRepeat) lighting.leds[2] = 1;
    return lighting;
  });
  EXPECT_EQ(t.verdict.sentence, "LED 2 stays lit");
  EXPECT_TRUE(t.verdict.accuses_all) << "nobody knows since when";
  EXPECT_FALSE(t.verdict.may_pass()) << "somebody has to look at it";
}

TEST(LightEvidence, TellsALampInTheRoomFromTheFirstShotOn) {
  const Told t = told(woven(), [](int led) {
    Lighting lighting = as_planned(led);
    lighting.room = 0.1;
    return lighting;
  });
  EXPECT_EQ(t.verdict.finding, LightFinding::kRoomLight);
  EXPECT_EQ(t.at, 0) << "by the dark shot";
}

TEST(LightEvidence, TellsALampThatIsSwitchedOnMeanwhileAtTheRepeatAtLatest) {
  const Told t = told(woven(), [](int led) {
    Lighting lighting = as_planned(led);
    if (led > 6 || led == kRepeat) lighting.room = 0.5;
    return lighting;
  });
  EXPECT_NE(t.verdict.finding, LightFinding::kAgrees);
}

TEST(LightEvidence, BelievesNoFrameWhereALampWasOnAndIsOutAgain) {
  const Told t = told(woven(), [](int led) {
    Lighting lighting = as_planned(led);
    if (led == 3 || led == 4) lighting.room = 0.5;
    return lighting;
  });
  EXPECT_EQ(t.verdict.finding, LightFinding::kRoomLight) << t.verdict.sentence;
  EXPECT_TRUE(t.verdict.accuses_all);
  EXPECT_TRUE(t.verdict.is_over && t.verdict.may_pass()) << "so all are taken again at once";
}

/// A session whose first or last dark shot has light of the room: below 0 it is the first.
Told with_light_between(double room) {
  return told(woven(), [room](int led) {
    Lighting lighting = as_planned(led);
    if (led == (room < 0 ? 0 : kDarkAgain)) lighting.room = std::abs(room);
    return lighting;
  });
}

TEST(LightEvidence, SpeaksOfLittleLightThatCameBetweenTheTwoDarkShots) {
  for (const double room : {0.0, 1e-3, -1e-3, 5e-3}) {
    const Told t = with_light_between(room);
    EXPECT_EQ(t.verdict.finding, LightFinding::kAgrees) << "it is kept: " << t.verdict.sentence;
    EXPECT_EQ(t.verdict.doubt, room == 0 ? LightFinding::kAgrees : LightFinding::kRoomLight) << room;
    ASSERT_EQ(t.warnings.size(), room == 0 ? 0U : 1U) << room;
    if (room == 0) continue;
    EXPECT_THAT(t.warnings.front(), HasSubstr(room < 0 ? "the dark shot at the end is darker"
                                                       : "the dark shot at the end is brighter"));
  }
}

TEST(LightEvidence, AccusesAllFramesWhereALampIsOnAtTheEnd) {
  for (const double room : {0.1, 0.5, 5.0}) {
    const Told t = with_light_between(room);
    EXPECT_EQ(t.verdict.finding, LightFinding::kRoomLight) << room;
    EXPECT_TRUE(t.verdict.accuses_all) << room;
    EXPECT_FALSE(t.verdict.may_pass()) << "somebody has to put it out";
  }
}

TEST(LightEvidence, BelievesNoFrameWhereOneIsFullAndTheOthersAreNot) {
  for (const int from : {1, 3, 6}) {
    const Told t = told(woven(), [from](int led) {
      Lighting lighting = as_planned(led);
      if (led == from || led == from + 1) lighting.room = 5;
      return lighting;
    });
    EXPECT_EQ(t.verdict.finding, LightFinding::kRoomLight) << t.verdict.sentence;
    EXPECT_TRUE(t.verdict.accuses_all);
    EXPECT_EQ(t.verdict.is_over, from < 6) << "four frames that are not full tell of one that is";
  }
}

TEST(LightEvidence, SpeaksOfDriftFromHalfAPercentOn) {
  const auto fading = [](double to) {
    return [to](int led) { return led == kRepeat ? Lighting{{{1, to}}, 0} : as_planned(led); };
  };
  const Told still = told(woven(), fading(0.997));
  EXPECT_TRUE(still.warnings.empty());
  const Told fades = told(woven(), fading(0.993));
  EXPECT_EQ(fades.verdict.finding, LightFinding::kAgrees);
  ASSERT_EQ(fades.warnings.size(), 1u);
  EXPECT_THAT(fades.warnings.front(), HasSubstr("percent less light at the end"));
}

TEST(LightEvidence, WithoutACalibrationStillTellsDarknessAndAChangedRepeat) {
  Told t = told(
      woven(), [](int led) { return led == 5 ? Lighting() : as_planned(led); }, false);
  EXPECT_EQ(t.verdict.sentence, "LED 5 is dark");
  t = told(
      woven(), [](int led) { return as_planned(led == kRepeat ? 7 : led); }, false);
  EXPECT_EQ(t.verdict.finding, LightFinding::kChanged) << t.verdict.sentence;
}

TEST(PatchGrid, LiesInsideTheFrameOnWholeFilterCells) {
  for (const Size size : {Size{22, 22}, Size{96, 64}, Size{641, 479}, Size{4928, 3264}}) {
    const PatchGrid grid = PatchGrid::over(size);
    for (int i = 0; i < grid.count(); ++i) {
      const Rect patch = grid.patch(i);
      ASSERT_TRUE(patch.x0 >= 0 && patch.y0 >= 0 && patch.x1 <= size.width && patch.y1 <= size.height)
          << size.width << " x " << size.height << ", patch " << i;
      ASSERT_EQ((patch.x0 | patch.y0 | grid.side) & 1, 0);
    }
  }
}

}  // namespace
}  // namespace weft::capture
