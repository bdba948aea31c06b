// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/materials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/reflectance/pixels.h"

namespace weft::solver {
namespace {

constexpr std::size_t kOfEach = 400;  // of each material
const Lobe kMatt = {};
const Lobe kLustrous = {.family = LobeFamily::kGgx, .alpha = 0.2, .f0 = 0.05};
const Lobe kBroad = {.family = LobeFamily::kBeckmann, .alpha = 0.45, .f0 = 0.06};

// Pixels of two materials, one after the other.
PixelTruth both(const PixelModel& a, const PixelModel& b, const ClothOfPixels& cloth) {
  const std::array<PixelTruth, 2> parts = {pixels_of(a, kOfEach, cloth, 11),
                                           pixels_of(b, kOfEach, cloth, 12)};
  PixelTruth mixed;
  for (std::size_t i = 0; i < kOfEach; ++i) {
    for (const PixelTruth& part : parts) {
      mixed.samples.add(part.samples.of(i));
      mixed.b.push_back(part.b[i]);
      mixed.start.push_back(part.start[i]);
    }
  }
  return mixed;
}

TEST(Materials, OfPlainClothAreOneMeasuredAsByItself) {
  const PixelTruth cloth = pixels_of(model_of(kLustrous), kOfEach, {}, 11);
  const std::vector<MeasuredLobe> found = measure_materials(cloth.samples, cloth.start, 0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().lobe, measure_lobe(cloth.samples, cloth.start, 0).lobe);
}

TEST(Materials, AreALobeAndLambertsLawWhereHalfOfTheClothIsMatt) {
  const PixelTruth cloth = both(model_of(kLustrous), model_of(kMatt), {.albedo = 0.2});
  const std::vector<MeasuredLobe> found = measure_materials(cloth.samples, cloth.start, 0);
  ASSERT_EQ(found.size(), 2U) << "one lobe: " << name_of(found.front().refusal);
  ASSERT_TRUE(found[0].is_measured());
  EXPECT_NEAR(found[0].lobe.alpha, 0.2, 0.01);
  EXPECT_NEAR(found[0].lobe.f0, 0.05, 0.0025);
  EXPECT_EQ(found[1].refusal, LobeRefusal::kLambertFits) << name_of(found[1].refusal);
}

TEST(Materials, AreTwoLobesWhereEachHalfHasItsOwn) {
  const PixelTruth cloth = both(model_of(kLustrous), model_of(kBroad), {.albedo = 0.1});
  std::vector<MeasuredLobe> found = measure_materials(cloth.samples, cloth.start, 0);
  ASSERT_EQ(found.size(), 2U) << "one lobe: " << name_of(found.front().refusal);
  ASSERT_TRUE(found[0].is_measured() && found[1].is_measured())
      << name_of(found[0].refusal) << " " << name_of(found[1].refusal);
  if (found[0].lobe.alpha > found[1].lobe.alpha) std::swap(found[0], found[1]);
  EXPECT_NEAR(found[0].lobe.alpha, 0.2, 0.01);
  EXPECT_NEAR(found[0].lobe.f0, 0.05, 0.0025);
  EXPECT_NEAR(found[1].lobe.alpha, 0.45, 0.05);
  EXPECT_NEAR(found[1].lobe.f0, 0.06, 0.2 * 0.06);
}

TEST(Materials, AreThreeWhereAMattStripeLiesBetweenTwoThatShine) {
  const Lobe wide = {.family = LobeFamily::kGgx, .alpha = 0.42, .f0 = 0.04},
             narrow = {.family = LobeFamily::kGgx, .alpha = 0.22, .f0 = 0.05};
  const std::array<PixelTruth, 3> stripes = {pixels_of(model_of(narrow), kOfEach, {.albedo = 0.08}, 21),
                                             pixels_of(model_of(kMatt), kOfEach, {.albedo = 0.5}, 22),
                                             pixels_of(model_of(wide), kOfEach, {.albedo = 0.3}, 23)};
  PixelTruth cloth;
  for (std::size_t i = 0; i < kOfEach; ++i) {
    for (const PixelTruth& stripe : stripes) {
      cloth.samples.add(stripe.samples.of(i));
      cloth.start.push_back(stripe.start[i]);
    }
  }
  std::vector<MeasuredLobe> found = measure_materials(cloth.samples, cloth.start, 0);
  ASSERT_EQ(found.size(), 3U) << "the first: " << name_of(found.front().refusal);
  ASSERT_TRUE(found[0].is_measured() && found[1].is_measured());
  if (found[0].lobe.alpha > found[1].lobe.alpha) std::swap(found[0], found[1]);
  EXPECT_NEAR(found[0].lobe.alpha, 0.22, 0.015);
  EXPECT_NEAR(found[1].lobe.alpha, 0.42, 0.015);
  EXPECT_EQ(found[2].refusal, LobeRefusal::kLambertFits) << name_of(found[2].refusal);
}

// Every third pixel is of both.
TEST(Materials, ThatFadeIntoEachOtherAreTold) {
  PixelTruth cloth = both(model_of(kLustrous), model_of(kMatt), {.albedo = 0.1});
  Random random(14);
  for (std::size_t i = 0; i < kOfEach; ++i) {
    const Vec3 n = random_normal(random, 25);
    const double matt = random.uniform();
    const PixelModel faded = [&](Vec3 normal, double albedo, double yarn, const LitFrom& from) {
      return (1 - matt) * model_of(kLustrous)(normal, albedo, yarn, from) +
             matt * model_of(kMatt)(normal, albedo, yarn, from);
    };
    cloth.samples.add(readings_of(faded, n, 0.1, 0, 0.003, random));
    cloth.start.push_back(lambert_fit(cloth.samples.of(cloth.samples.pixels() - 1)));
  }
  // As they lie all over a frame.
  PixelTruth mixed;
  for (std::size_t i = 0; i < 3 * kOfEach; ++i) {
    const std::size_t from = i % 3 == 2 ? 2 * kOfEach + i / 3 : 2 * (i / 3) + i % 3;
    mixed.samples.add(cloth.samples.of(from));
    mixed.start.push_back(cloth.start[from]);
  }
  const std::vector<MeasuredLobe> found = measure_materials(mixed.samples, mixed.start, 0);
  ASSERT_EQ(found.size(), 2U) << "one lobe: " << name_of(found.front().refusal);
  ASSERT_TRUE(found[0].is_measured());
  EXPECT_NEAR(found[0].lobe.alpha, 0.2, 0.01);
  EXPECT_NEAR(found[0].lobe.f0, 0.05, 0.004);
  EXPECT_EQ(found[1].refusal, LobeRefusal::kLambertFits) << name_of(found[1].refusal);
}

TEST(Materials, AreLikeMetalWhereAThirdOfThePixelsMirrorsAsNoFibreDoes) {
  const Lobe metal = {.family = LobeFamily::kGgx, .alpha = 0.3, .f0 = 0.75};
  const PixelTruth yarn = pixels_of(model_of(metal), kOfEach / 2, {.albedo = 0.004}, 31),
                   ground = pixels_of(model_of(kMatt), kOfEach, {.albedo = 0.2}, 32);
  PixelTruth cloth;
  for (std::size_t i = 0; i < kOfEach; ++i) {
    cloth.samples.add(ground.samples.of(i));
    cloth.start.push_back(ground.start[i]);
    if (i % 2 == 0) continue;
    cloth.samples.add(yarn.samples.of(i / 2));
    cloth.start.push_back(yarn.start[i / 2]);
  }
  const std::vector<MeasuredLobe> found = measure_materials(cloth.samples, cloth.start, 0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(is_like_metal(found.front())) << name_of(found.front().refusal);
  const PixelTruth satin = pixels_of(model_of(kLustrous), kOfEach, {.albedo = 0.2}, 33);
  EXPECT_FALSE(is_like_metal(measure_materials(satin.samples, satin.start, 0).front()));
}

TEST(Materials, AreNotMadeOfWhatNoLobeExplains) {
  // Light between yarns: a share of what the darkest side of a pixel gets.
  const PixelModel model = [](Vec3 n, double albedo, double yarn, const LitFrom& from) {
    const double bounced = 0.5 * albedo * (1 - n.z) * std::pow(1 - dot(n, from.light), 2);
    return modelled(kLustrous, albedo * n, from, yarn) + bounced;
  };
  const PixelTruth cloth = pixels_of(model, 2 * kOfEach, {.tilt_deg = 50}, 13);
  const std::vector<MeasuredLobe> found = measure_materials(cloth.samples, cloth.start, 0);
  ASSERT_TRUE(may_be_two(found.front()) || found.size() == 2) << "the case is too easy";
  EXPECT_EQ(found.size(), 1U);
}

}  // namespace
}  // namespace weft::solver
