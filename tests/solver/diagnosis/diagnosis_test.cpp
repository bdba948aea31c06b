// SPDX-License-Identifier: Apache-2.0
#include "solver/diagnosis/diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>

#include "bench/oracles/oracle_rig.h"
#include "core/rig/light_field.h"
#include "solver/diagnosis/robust_fit.h"

namespace weft::solver {
namespace {

using test::Random;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Matt cloth of slopes up to 30 degrees under the ten LEDs of the rig as distant lights, with 0.5 percent of
/// noise. Lights in attached shadow read 0.
Evidence cloth(std::uint64_t seed, std::size_t pixels = 300) {
  Random random(seed);
  const NearLights rig = test::ten_leds();
  Evidence evidence;
  evidence.lights = rig.leds.size();
  for (std::size_t p = 0; p < pixels; ++p) {
    evidence.position.push_back({2 * random.uniform() - 1, 2 * random.uniform() - 1});
    const Vec3 n = test::random_normal(random, 30);
    const double albedo = 0.2 + 0.6 * random.uniform();
    for (std::size_t k = 0; k < evidence.lights; ++k) {
      const Vec3 l = normalized(rig.leds[k].position_mm);
      const double strength = 2 + 0.1 * static_cast<double>(k);
      const double lit = strength * albedo * std::max(0.0, dot(n, l));
      evidence.rows.push_back({l, strength, lit + 0.005 * strength * albedo * random.normal()});
    }
  }
  return evidence;
}

EvidenceRow& row(Evidence& evidence, std::size_t pixel, std::size_t light) {
  return evidence.rows[pixel * evidence.lights + light];
}

/// `made_of(pixel, led)` becomes the reading of a LED, by its number from 1.
template <typename F>
void change(Evidence& evidence, int led, const F& made_of) {
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    EvidenceRow& r = row(evidence, p, static_cast<std::size_t>(led - 1));
    r.reading = made_of(r.reading, p);
  }
}

void swap_photographs(Evidence& evidence, int a, int b) {
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    std::swap(row(evidence, p, static_cast<std::size_t>(a - 1)).reading,
              row(evidence, p, static_cast<std::size_t>(b - 1)).reading);
  }
}

/// Traps: a share of the readings cast into shadow, as large a share highlights of up to four times the
/// light.
void add_shadows_and_highlights(Evidence& evidence, double share, std::uint64_t seed) {
  Random random(seed);
  for (EvidenceRow& r : evidence.rows) {
    const double kind = random.uniform();
    if (kind < share) r.reading *= 0.3;
    if (kind > 1 - share) r.reading *= 1 + 3 * random.uniform();
  }
}

std::string words(const Diagnosis& diagnosis) {
  std::string text;
  for (const Fault& f : diagnosis.faults) {
    text += "kind " + std::to_string(static_cast<int>(f.kind)) + " of";
    for (const std::size_t k : f.lights) text += " " + std::to_string(k + 1);
    text += ", value " + std::to_string(f.value) + ", residual " + std::to_string(f.residual_before) +
            " to " + std::to_string(f.residual_after) + "; ";
  }
  return text;
}

class DiagnosisOfSeed : public testing::TestWithParam<int> {
 protected:
  std::uint64_t seed() const { return static_cast<std::uint64_t>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Seeds, DiagnosisOfSeed, testing::Range(1, 9));

TEST_P(DiagnosisOfSeed, NamesNothingOnHealthyCloth) {
  Evidence evidence = cloth(seed());
  EXPECT_THAT(diagnose(evidence).faults, IsEmpty()) << words(diagnose(evidence));
  add_shadows_and_highlights(evidence, 0.16, seed() + 100);
  EXPECT_THAT(diagnose(evidence).faults, IsEmpty()) << words(diagnose(evidence));
}

TEST_P(DiagnosisOfSeed, NamesTwoSwappedPhotographs) {
  Evidence evidence = cloth(seed());
  swap_photographs(evidence, 3, 4);
  for (int trap = 0; trap < 2; ++trap) {
    const Diagnosis d = diagnose(evidence);
    ASSERT_EQ(d.faults.size(), 1U) << words(d);
    EXPECT_EQ(d.faults[0].kind, FaultKind::kExchanged);
    EXPECT_THAT(d.faults[0].lights, ElementsAre(2, 3));
    EXPECT_THAT(d.faults[0].shown_by, ElementsAre(3, 2));
    EXPECT_GE(d.faults[0].agreement, 0.99);
    EXPECT_LT(d.left, d.residual);
    add_shadows_and_highlights(evidence, 0.08, seed() + 100);
  }
}

TEST_P(DiagnosisOfSeed, NamesTwoSwappedPairs) {
  Evidence evidence = cloth(seed());
  swap_photographs(evidence, 3, 4);
  swap_photographs(evidence, 6, 9);
  const Diagnosis d = diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 2U) << words(d);
  EXPECT_THAT(d.faults[0].lights, ElementsAre(2, 3));
  EXPECT_THAT(d.faults[1].lights, ElementsAre(5, 8));
}

TEST_P(DiagnosisOfSeed, NamesTheOrderOfThreePhotographs) {
  Evidence evidence = cloth(seed());
  swap_photographs(evidence, 3, 4);  // LED 3 is now seen in photograph 4 ...
  swap_photographs(evidence, 4, 8);  // ... and now in 8, LED 8 in 4, LED 4 in 3
  const Diagnosis d = diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 1U) << words(d);
  EXPECT_THAT(d.faults[0].lights, ElementsAre(2, 7, 3));
  EXPECT_THAT(d.faults[0].shown_by, ElementsAre(7, 3, 2));
}

TEST_P(DiagnosisOfSeed, NamesADeadLed) {
  Evidence evidence = cloth(seed());
  Random random(seed());
  change(evidence, 5, [&](double, std::size_t) { return 0.002 * random.normal(); });
  const Diagnosis d = diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 1U) << words(d);
  EXPECT_EQ(d.faults[0].kind, FaultKind::kDead);
  EXPECT_THAT(d.faults[0].lights, ElementsAre(4));
  EXPECT_NEAR(d.faults[0].value, 0, 0.01);
}

TEST_P(DiagnosisOfSeed, MeasuresADimmedLed) {
  Evidence evidence = cloth(seed());
  change(evidence, 7, [](double r, std::size_t) { return 0.96 * r; });
  const Diagnosis d = diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 1U) << words(d);
  EXPECT_EQ(d.faults[0].kind, FaultKind::kGain);
  EXPECT_THAT(d.faults[0].lights, ElementsAre(6));
  EXPECT_NEAR(d.faults[0].value, 0.96, 0.005);
  EXPECT_GT(d.faults[0].moved_deg, 0.1);
}

TEST(Diagnosis, MeasuresADimmedLedBesideASwappedPair) {
  Evidence evidence = cloth(11);
  change(evidence, 7, [](double r, std::size_t) { return 1.05 * r; });
  swap_photographs(evidence, 3, 4);
  const Diagnosis d = diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 2U) << words(d);
  EXPECT_THAT(d.faults[0].lights, ElementsAre(2, 3));
  EXPECT_THAT(d.faults[1].lights, ElementsAre(6));
  EXPECT_NEAR(d.faults[1].value, 1.05, 0.006);
}

TEST(Diagnosis, TakesWhatDependsOnTheZenithAngleForTheCloth) {
  Evidence evidence = cloth(12);
  for (EvidenceRow& r : evidence.rows) r.reading *= std::exp(0.3 * r.direction.z * r.direction.z);
  const Diagnosis d = diagnose(evidence);
  EXPECT_THAT(d.faults, IsEmpty()) << words(d);
  EXPECT_LT(d.left, 0.3 * d.residual) << d.residual << " to " << d.left;
}

TEST(Diagnosis, TakesWhatDependsOnTheWayTheClothFacesForTheCloth) {
  Evidence evidence = cloth(13);
  // A highlight of LED 7 alone, towards the half vector of light and view.
  Random random(13);
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    row(evidence, p, 6).reading *= 1 + 0.4 * random.uniform();
  }
  EXPECT_THAT(diagnose(evidence).faults, testing::Not(IsEmpty())) << "a LED that is brighter is named";
  evidence = cloth(13);
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    RobustFit fit;
    ASSERT_TRUE(fit.fit(evidence, p, LightModel::as_calibrated(10), 6));
    const Vec3 half = normalized(evidence.at(p, 6).direction + Vec3{0, 0, 1});
    row(evidence, p, 6).reading *= 1 + 1.5 * std::pow(std::max(0.0, dot(half, fit.normal())), 30);
  }
  EXPECT_THAT(diagnose(evidence).faults, IsEmpty()) << words(diagnose(evidence));
}

TEST(Diagnosis, CountsWhatIsLeftOut) {
  Evidence evidence = cloth(14);
  change(evidence, 1, [](double r, std::size_t p) { return p % 4 == 0 ? kInfinity : r; });
  change(evidence, 2, [](double r, std::size_t p) { return p % 5 == 0 ? std::nan("") : r; });
  change(evidence, 3, [](double r, std::size_t p) { return p % 10 == 0 ? -kInfinity : r; });
  const Diagnosis d = diagnose(evidence);
  EXPECT_EQ(d.pixels, evidence.pixels());
  EXPECT_NEAR(d.lights[0].saturated, 0.25, 1e-9);
  EXPECT_NEAR(d.lights[1].missing, 0.2, 1e-9);
  EXPECT_NEAR(d.lights[2].shadowed, 0.1, 0.01);
  EXPECT_THAT(d.faults, IsEmpty()) << words(d);
}

TEST(Diagnosis, SeesALightWhoseResidualTiltsOverTheFrame) {
  Evidence evidence = cloth(15);
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    row(evidence, p, 8).reading *= 1 + 0.1 * evidence.position[p][0];
  }
  const Diagnosis d = diagnose(evidence);
  EXPECT_GT(d.lights[8].gradient_share, 0.5) << d.lights[8].gradient;
  EXPECT_GT(d.lights[8].gradient, 0.03);
  EXPECT_LT(d.lights[0].gradient_share, 0.1) << d.lights[0].gradient;
}

TEST(Diagnosis, NamesNothingOfFewerThanSixLights) {
  Evidence few = cloth(16), all = few;
  few.lights = 5;
  few.rows.clear();
  for (std::size_t p = 0; p < all.pixels(); ++p) {
    for (std::size_t k = 0; k < 5; ++k) few.rows.push_back(row(all, p, k));
  }
  swap_photographs(few, 3, 4);
  const Diagnosis d = diagnose(few);
  EXPECT_THAT(d.faults, IsEmpty());
  EXPECT_EQ(d.lights.size(), 5U);
}

TEST(Diagnosis, LooksAtNoPixelThatIsDarkOrEmpty) {
  Evidence dark = cloth(17);
  dark.noise = NoiseModel{0, 1, 0};
  EXPECT_EQ(diagnose(dark).pixels, 0U);
  Evidence empty = cloth(17);
  for (EvidenceRow& r : empty.rows) r.reading = std::nan("");
  EXPECT_EQ(diagnose(empty).pixels, 0U);
  EXPECT_EQ(diagnose({.lights = 10, .rows = {}, .position = {}, .noise = {}}).pixels, 0U);
}

TEST(Diagnosis, DoesNotDependOnThreads) {
  Evidence evidence = cloth(18);
  swap_photographs(evidence, 1, 10);
  change(evidence, 7, [](double r, std::size_t) { return 0.93 * r; });
  const Diagnosis one = diagnose(evidence, 1), many = diagnose(evidence, 7);
  ASSERT_EQ(one.faults.size(), many.faults.size());
  for (std::size_t i = 0; i < one.faults.size(); ++i) {
    EXPECT_EQ(one.faults[i].value, many.faults[i].value);
    EXPECT_EQ(one.faults[i].residual_after, many.faults[i].residual_after);
  }
  EXPECT_EQ(one.left, many.left);
}

TEST(RobustFit, IsNotBentByTwoWrongReadingsOfTen) {
  Evidence evidence = cloth(19, 1);
  const Vec3 n = normalized({0.2, -0.1, 1});
  for (EvidenceRow& r : evidence.rows) r.reading = 0.4 * r.strength * dot(n, r.direction);
  row(evidence, 0, 0).reading *= 3;
  row(evidence, 0, 5).reading *= 0.4;
  RobustFit fit;
  ASSERT_TRUE(fit.fit(evidence, 0, LightModel::as_calibrated(10)));
  EXPECT_LT(angle_deg(fit.normal(), n), 0.5);
  EXPECT_NEAR(fit.albedo(), 0.4, 0.01);
  ASSERT_TRUE(fit.fit(evidence, 0, LightModel::as_calibrated(10), RobustFit::kNone, 1));
  EXPECT_GT(angle_deg(fit.normal(), n), 5) << "plain least squares is";
}

}  // namespace
}  // namespace weft::solver
