// SPDX-License-Identifier: Apache-2.0
#include "solve/gloss/gloss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/solve/solve_record.h"
#include "core/solve/status_blend.h"
#include "solve/levels/frame.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kSize = {256, 192};
const solver::Lobe kSilk = {.family = solver::LobeFamily::kGgx, .alpha = 0.25, .f0 = 0.05};

// Waves to both sides, 20 degrees at their steepest.
Vec3 dented(int x, int y) {
  return normalized({0.26 * std::sin(2 * kPi * x / 37), 0.26 * std::sin(2 * kPi * y / 23), 1});
}

double mean_error_deg(const WholeMaps& maps) {
  double sum = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) sum += angle_deg(maps.normal_at(x, y), dented(x, y));
  }
  return sum / static_cast<double>(kSize.pixels());
}

double glossy_share(const WholeMaps& maps) {
  double glossy = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) glossy += (maps.status(x, y) & kGlossy) != 0 ? 1 : 0;
  }
  return glossy / static_cast<double>(kSize.pixels());
}

FrameFacts solve(const Photographs& photographs, const char* level, WholeMaps& maps) {
  auto facts =
      solve_frame(photographs, *solver::find_method(level), kSolveTile, {.threads = 2}, std::ref(maps));
  EXPECT_TRUE(facts) << facts.error().message();
  return facts ? std::move(*facts) : FrameFacts{};
}

TEST(Gloss, OfDarkClothIsFoundAndItsNormalsAreRight) {
  const Photographs photographs =
      mosaics(kSize, {.normal = dented, .albedo = {0.1, 0.08, 0.06}, .lobe = kSilk});
  WholeMaps by_standard(kSize), by_robust(kSize);
  solve(photographs, "standard", by_standard);
  const FrameFacts facts = solve(photographs, "robust", by_robust);
  ASSERT_TRUE(facts.gloss && facts.gloss->is_measured());
  EXPECT_NEAR(facts.gloss->lobes.front().lobe.alpha, 0.25, 0.01);
  EXPECT_NEAR(facts.gloss->lobes.front().lobe.f0, 0.05, 0.0025);
  EXPECT_EQ(facts.gloss->share, 1);
  EXPECT_GT(glossy_share(by_robust), 0.99);
  EXPECT_LT(mean_error_deg(by_robust), 0.3) << "by standard " << mean_error_deg(by_standard);
  EXPECT_GT(mean_error_deg(by_standard), 1.5);
}

TEST(Gloss, IsTheSameForIntensitiesOfAnyScaleWhereTheAlbedoHasNone) {
  const Cloth cloth = {.normal = dented, .albedo = {0.1, 0.08, 0.06}, .lobe = kSilk};
  for (const double scale : {1e-12, 20.0}) {
    Photographs photographs = developed(kSize, cloth);
    photographs.field = *LightField::make(ten_lights({scale, scale, scale}), std::nullopt, kSize, 0);
    photographs.albedo_scale = AlbedoScale::kRelative;
    WholeMaps maps(kSize);
    const FrameFacts facts = solve(photographs, "robust", maps);
    ASSERT_TRUE(facts.gloss && facts.gloss->is_measured()) << "times " << scale;
    EXPECT_EQ(facts.gloss->share, 1) << "times " << scale;
    EXPECT_LT(mean_error_deg(maps), 0.1) << "times " << scale;
    const solver::MeasuredLobe& lobe = facts.gloss->lobes.front();
    EXPECT_NEAR(lobe.lobe.alpha, kSilk.alpha, 0.01) << "times " << scale;
    // 0.083 is the weighted sum of the albedo's channels.
    EXPECT_NEAR(lobe.lobe.f0 / lobe.median_albedo, 0.05 / 0.083, 0.03) << "times " << scale;
    EXPECT_NEAR(maps.albedo(100, 80, 0) * scale, 0.1, 0.003) << "times " << scale;
  }
}

TEST(Gloss, UnderDistantLightsIsFoundWhereTheCameraIsKnown) {
  Photographs photographs = mosaics(kSize, {.normal = dented, .albedo = {0.1, 0.08, 0.06}, .lobe = kSilk});
  photographs.camera = overhead_camera(kSize, 600, 0.08);
  WholeMaps maps(kSize);
  const FrameFacts facts = solve(photographs, "robust", maps);
  ASSERT_TRUE(facts.gloss && facts.gloss->is_measured());
  EXPECT_LT(mean_error_deg(maps), 0.3);
}

TEST(Gloss, OfDevelopedPhotographsLeavesEachChannelItsAlbedo) {
  const Cloth cloth = {.normal = dented, .albedo = {0.3, 0.15, 0.05}, .lobe = kSilk};
  WholeMaps maps(kSize);
  const FrameFacts facts = solve(developed(kSize, cloth), "robust", maps);
  ASSERT_TRUE(facts.gloss && facts.gloss->is_measured());
  ASSERT_EQ(facts.gloss->share, 1);
  for (int c = 0; c < 3; ++c) {
    const double albedo = cloth.albedo[static_cast<std::size_t>(c)];
    EXPECT_NEAR(maps.albedo(100, 80, c), albedo, 0.02 * albedo) << "channel " << c;
  }
}

// A highlight that is white or golden, on a cloth whose dye has another colour.
TEST(Gloss, OfAColourOfItsOwnLeavesEachChannelItsAlbedo) {
  const std::array<double, 3> gold = {0.1, 0.08, 0.04};
  Cloth cloth = {.normal = dented, .albedo = {0.06, 0.1, 0.2}, .lobe = kSilk};
  cloth.lobe.f0 = 0.2126 * gold[0] + 0.7152 * gold[1] + 0.0722 * gold[2];
  for (std::size_t c = 0; c < 3; ++c) cloth.lobe.tint[c] = gold[c] / cloth.lobe.f0;
  for (const bool is_mosaic : {true, false}) {
    WholeMaps maps(kSize);
    const FrameFacts facts =
        solve(is_mosaic ? mosaics(kSize, cloth) : developed(kSize, cloth), "robust", maps);
    ASSERT_TRUE(facts.gloss && facts.gloss->is_measured()) << is_mosaic;
    ASSERT_EQ(facts.gloss->f0_of_channels.size(), 1U);
    ASSERT_TRUE(facts.gloss->f0_of_channels[0]) << is_mosaic;
    EXPECT_EQ(facts.gloss->share, 1) << is_mosaic;
    EXPECT_LT(mean_error_deg(maps), 0.3) << is_mosaic;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(facts.gloss->f0_of_channels[0]->f0[c], gold[c], 0.03 * gold[c]) << "channel " << c;
      EXPECT_NEAR(maps.albedo(100, 80, static_cast<int>(c)), cloth.albedo[c], 0.02 * cloth.albedo[c])
          << "channel " << c << (is_mosaic ? " of mosaics" : " of RGB");
    }
  }
  cloth.lobe.tint = {1, 1, 1};
  WholeMaps maps(kSize);
  const FrameFacts white = solve(mosaics(kSize, cloth), "robust", maps);
  ASSERT_TRUE(white.gloss && white.gloss->is_measured());
  EXPECT_FALSE(white.gloss->f0_of_channels[0]);
}

TEST(Gloss, OfCrossedYarnsSaysOfEachPixelWhichItIs) {
  const auto is_weft = [](int x, int y) { return (x / 8 + y / 8) % 2 == 1; };
  const Cloth cloth = {.normal = dented,
                       .albedo = {0.1, 0.08, 0.06},
                       .lobe = {.family = solver::LobeFamily::kAnisotropicGgx,
                                .alpha = 0.4,
                                .f0 = 0.05,
                                .along = 0.35,
                                .axis = radians(20)},
                       .yarn = [&](int x, int y) { return is_weft(x, y) ? kPi / 2 : 0; }};
  WholeMaps maps(kSize);
  const FrameFacts facts = solve(mosaics(kSize, cloth), "robust", maps);
  ASSERT_TRUE(facts.gloss && facts.gloss->is_measured());
  // Which of the two is called warp is open: the axis says.
  const double axis = degrees(facts.gloss->lobes.front().lobe.axis);
  const bool is_turned = std::abs(std::remainder(axis - 110, 180)) < 45;
  EXPECT_NEAR(std::remainder(axis - (is_turned ? 110 : 20), 180), 0, 1) << axis;
  std::int64_t right = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const bool is_across = (maps.status(x, y) & kYarnAcross) != 0;
      right += (is_across != is_turned) == is_weft(x, y) ? 1 : 0;
    }
  }
  EXPECT_GT(static_cast<double>(right) / static_cast<double>(kSize.pixels()), 0.98);
}

TEST(Gloss, OfAPrintOnMattClothIsUsedWhereThePrintIs) {
  const auto is_matt = [](int x, int y) { return (x / 24 + y / 24) % 2 == 1; };
  const Cloth cloth = {.normal = dented, .albedo = {0.1, 0.08, 0.06}, .lobe = kSilk, .is_matt = is_matt};
  WholeMaps maps(kSize), by_standard(kSize);
  const FrameFacts facts = solve(mosaics(kSize, cloth), "robust", maps);
  solve(mosaics(kSize, cloth), "standard", by_standard);
  ASSERT_TRUE(facts.gloss && facts.gloss->is_measured());
  ASSERT_EQ(facts.gloss->lobes.size(), 2U);
  EXPECT_NEAR(facts.gloss->lobes[0].lobe.alpha, 0.25, 0.01);
  EXPECT_NEAR(facts.gloss->lobes[0].lobe.f0, 0.05, 0.0025);
  EXPECT_EQ(facts.gloss->lobes[1].refusal, solver::LobeRefusal::kLambertFits);
  std::int64_t right = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x)
      right += ((maps.status(x, y) & kGlossy) == 0) == is_matt(x, y) ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(right) / static_cast<double>(kSize.pixels()), 0.97);
  EXPECT_LT(mean_error_deg(maps), 0.3) << "by standard " << mean_error_deg(by_standard);
}

// A print that fades into matt cloth over eight pixels, as the lens or the ink has it.
TEST(Gloss, OfAPrintThatFadesIsSolvedAsBothMaterials) {
  const auto matt_share = [](int x, int) {
    const double at = std::abs(std::remainder(x + 0.5, 64.0));  // 0 to 32: from matt to print
    return std::clamp((at - 12) / 8, 0.0, 1.0);
  };
  const Cloth cloth = {
      .normal = dented, .albedo = {0.1, 0.08, 0.06}, .lobe = kSilk, .matt_share = matt_share};
  WholeMaps maps(kSize);
  const FrameFacts facts = solve(mosaics(kSize, cloth), "robust", maps);
  ASSERT_TRUE(facts.gloss && facts.gloss->is_measured());
  ASSERT_EQ(facts.gloss->lobes.size(), 2U);
  const bool is_second_matt = facts.gloss->lobes[1].refusal == solver::LobeRefusal::kLambertFits;
  ASSERT_TRUE(is_second_matt);
  double turned = 0, astray = 0, off = 0, blended = 0, count = 0, blended_beside = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const bool is_blend = (maps.status(x, y) & kGlossy) != 0 && blend_of(maps.status(x, y)) > 0;
      const double matt = matt_share(x, y);
      if (matt == 0 || matt == 1) {
        blended_beside += is_blend ? 1 : 0;
        continue;
      }
      // What is nearly of one material is solved as of that.
      if (matt < 0.1 || matt > 0.9) continue;
      ++count;
      turned += angle_deg(maps.normal_at(x, y), dented(x, y));
      astray += std::abs(maps.albedo(x, y, 1) / 0.08 - 1);
      if (!is_blend) continue;
      ++blended;
      off += std::abs(second_share_of(maps.status(x, y)) - matt);
    }
  }
  EXPECT_LT(turned / count, 0.05) << "degrees over " << count << " pixels of both";
  EXPECT_LT(astray / count, 0.01) << "share of the albedo";
  EXPECT_GT(blended / count, 0.95);
  // All shares lie between two that a map holds.
  EXPECT_LT(off / blended, 0.07) << "of the share";
  EXPECT_LT(blended_beside, 0.001 * static_cast<double>(kSize.pixels()));
}

// Velvet's albedo is lost in its sheen by Lambert's law, and through crossed films it is not.
TEST(Gloss, OfAPairOfFilmsIsSheenAndLeavesTheAlbedo) {
  Cloth velvet = {.normal = dented,
                  .albedo = {0.04, 0.04, 0.04},
                  .lobe = {.family = solver::LobeFamily::kCloth, .alpha = 0.3, .f0 = 0.04}};
  const auto albedo_of = [&](const Photographs& photographs, FrameFacts& facts) {
    WholeMaps maps(kSize);
    facts = solve(photographs, "robust", maps);
    EXPECT_LT(mean_error_deg(maps), 0.5);
    double sum = 0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) sum += maps.albedo(x, y, 1) / static_cast<double>(kSize.pixels());
    }
    return sum;
  };
  FrameFacts alone, paired;
  const double without = albedo_of(mosaics(kSize, velvet), alone);
  velvet.lobe_share = 0.02;
  Photographs photographs = mosaics(kSize, velvet);
  velvet.lobe_share = 2;
  photographs.parallel = mosaics(kSize, velvet).frames;
  const double with = albedo_of(photographs, paired);
  EXPECT_FALSE(alone.gloss->is_measured());
  ASSERT_TRUE(paired.gloss->is_measured()) << name_of(paired.gloss->lobes.front().refusal);
  const solver::Lobe& lobe = paired.gloss->lobes.front().lobe;
  EXPECT_EQ(lobe.family, solver::LobeFamily::kCloth);
  EXPECT_NEAR(lobe.alpha, 0.3, 0.01);
  EXPECT_NEAR(lobe.f0, 0.04, 0.002);
  EXPECT_EQ(paired.gloss->share, 1);
  EXPECT_NEAR(with, 0.04, 0.02 * 0.04) << "without films " << without;
  EXPECT_GT(without, 1.1 * 0.04);
}

TEST(Gloss, WhoseRoughnessChangesAcrossTheFrameIsSeen) {
  const auto change_of = [](double rougher) {
    const Photographs photographs = mosaics(
        kSize,
        {.normal = dented, .albedo = {0.1, 0.08, 0.06}, .lobe = kSilk, .roughening = [rougher](int x, int) {
           return 1 + rougher * x / kSize.width;
         }});
    const auto base = solver::robust_method();
    const auto gloss = measure_gloss(photographs, *base, nullptr, 2);
    EXPECT_TRUE(gloss && gloss->lobes.size() == 1 && gloss->lobes.front().is_measured());
    EXPECT_EQ(gloss->lobes.front().parts.size(), solver::kFrameParts);
    return solver::change_across(gloss->lobes.front().parts);
  };
  EXPECT_FALSE(change_of(0));
  const auto change = change_of(0.2);
  ASSERT_TRUE(change);
  // The means of the halves: 5 and 15 percent rougher than at the left edge.
  EXPECT_EQ((*change)[0].part % 2, 0U) << "smoothest at the " << solver::name_of_part((*change)[0].part);
  EXPECT_EQ((*change)[1].part % 2, 1U) << "roughest at the " << solver::name_of_part((*change)[1].part);
  EXPECT_NEAR((*change)[0].alpha, 1.05 * kSilk.alpha, 0.01 * kSilk.alpha);
  EXPECT_NEAR((*change)[1].alpha, 1.15 * kSilk.alpha, 0.01 * kSilk.alpha);
}

TEST(Gloss, OfMattClothChangesNothing) {
  const Photographs photographs = mosaics(kSize, {.normal = dented});
  WholeMaps maps(kSize);
  const FrameFacts facts = solve(photographs, "robust", maps);
  ASSERT_TRUE(facts.gloss);
  EXPECT_EQ(facts.gloss->lobes.front().refusal, solver::LobeRefusal::kLambertFits);
  EXPECT_EQ(facts.gloss->share, 0);
  EXPECT_EQ(glossy_share(maps), 0);
}

}  // namespace
}  // namespace weft::solve
