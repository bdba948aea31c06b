// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/roughness_mips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "core/solve/solve_record.h"
#include "tests/material/made_surface.h"

namespace weft::material {
namespace {

Surface level_surface(Size size, double p = 0, double q = 0) {
  return made_surface(size, [=](int, int) { return std::array{p, q}; });
}

std::vector<MipLevel> mips_of(const Surface& surface, const MipOptions& options = {}) {
  Result<std::vector<MipLevel>> made = roughness_mips(surface, options);
  EXPECT_TRUE(made) << (made ? "" : made.error().message());
  return made ? std::move(*made) : std::vector<MipLevel>{};
}

Footprint footprint_of(std::initializer_list<Vec3> normals, LobeWidth lobe = {0.1, 0.1, 0}) {
  Footprint sum;
  for (const Vec3 n : normals) sum.add(1, normalized(n), lobe);
  return sum;
}

simulator::GeometrySettings satin() {
  simulator::GeometrySettings geometry;
  geometry.kind = simulator::GeometryKind::kSatin;
  geometry.flatness = 0.25;
  return geometry;
}

bool same_bytes(const Image<float>& a, const Image<float>& b) {
  for (int p = 0; p < a.planes(); ++p) {
    for (int y = 0; y < a.height(); ++y) {
      const auto bytes = static_cast<std::size_t>(a.width()) * sizeof(float);
      if (std::memcmp(a.plane(p).row(y), b.plane(p).row(y), bytes) != 0) return false;
    }
  }
  return true;
}

TEST(RoughnessMips, LeaveAlphaBitForBitWhereNormalsAreAlike) {
  for (const MipRuleName& rule : kMipRules) {
    for (const float alpha : {0.0F, 1e-3F, 0.1F, 0.333F, 0.7F, 1.0F}) {
      const Surface surface = level_surface({13, 7}, 0.3, -0.7);
      for (const MipLevel& level :
           mips_of(surface, {.rule = rule.rule, .alpha = double{alpha}, .finest = 0})) {
        for (int y = 0; y < level.lobe.height(); ++y) {
          for (int x = 0; x < level.lobe.width(); ++x) {
            ASSERT_EQ(level.lobe(x, y, 0), alpha) << rule.name << " level " << level.level;
            ASSERT_EQ(level.lobe(x, y, 1), alpha) << rule.name << " level " << level.level;
            ASSERT_NEAR(level.normal(x, y, 0), -0.3 / std::sqrt(1.58), 1e-7);
          }
        }
      }
    }
  }
}

TEST(RoughnessMips, KeepTheTwoRoughnessesOfASatinWhereNormalsAreAlike) {
  Surface surface = level_surface({8, 8});
  surface.lobe = Image<float>({8, 8}, 4);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const std::array<float, 4> lobe = {0.45F, 0.1575F, 30, 0.05F};
      for (int p = 0; p < 4; ++p) surface.lobe(x, y, p) = lobe[static_cast<std::size_t>(p)];
    }
  }
  for (const MipRuleName& rule : kMipRules) {
    const MipLevel last = std::move(mips_of(surface, {.rule = rule.rule}).back());
    EXPECT_EQ(last.lobe(0, 0, 0), 0.45F) << rule.name;
    EXPECT_EQ(last.lobe(0, 0, 1), 0.1575F) << rule.name;
    EXPECT_NEAR(last.lobe(0, 0, 2), 30, 1e-4) << rule.name;
  }
}

TEST(RoughnessMips, OfNormalsThatCancelAreLevelAndAsRoughAsCanBe) {
  for (const MipRuleName& rule : kMipRules) {
    const MipTexel none = filtered({}, rule.rule);
    const MipTexel cancelled = filtered(footprint_of({{1, 0, 0}, {-1, 0, 0}}), rule.rule);
    for (const MipTexel& texel : {none, cancelled}) {
      EXPECT_EQ(texel.normal, (Vec3{0, 0, 1})) << rule.name;
      EXPECT_EQ(texel.lobe.across, 1) << rule.name;
      EXPECT_EQ(texel.lobe.along, 1) << rule.name;
    }
  }
}

TEST(RoughnessMips, HaveNoJumpWhereNormalsBecomeAlikeAsTheSeedsListingHas) {
  const auto listing = [](double r) {
    const double kappa = r < 1 ? (3 * r - r * r * r) / (1 - r * r) : 10000;
    return std::sqrt(1 / kappa);
  };
  EXPECT_DOUBLE_EQ(listing(1), 0.01);
  EXPECT_LT(listing(1 - 6e-8), 0.0005);
  double before = 0;
  for (const double tilt : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    const MipTexel texel = filtered(footprint_of({{tilt, 0, 1}, {-tilt, 0, 1}}, {0, 0, 0}), MipRule::kVmf);
    EXPECT_GE(texel.lobe.across, before);
    EXPECT_NEAR(texel.lobe.across, tilt, 5e-7) << tilt;
    before = texel.lobe.across;
  }
  EXPECT_EQ(inverse_kappa(1), 0);
  EXPECT_EQ(inverse_kappa(1 + 1e-12), 0);
}

TEST(RoughnessMips, BecomeRoughWithoutAJumpWhereNormalsCancel) {
  for (const MipRule rule : {MipRule::kVmf, MipRule::kVmfYarns, MipRule::kToksvig, MipRule::kLengths}) {
    const MipTexel texel = filtered(footprint_of({{1, 0, 1e-6}, {-1, 0, 1e-6}}), rule);
    EXPECT_NEAR(texel.lobe.across, 1, 1e-4) << name_of(rule);
    EXPECT_NEAR(texel.lobe.along, 1, 1e-4) << name_of(rule);
  }
}

TEST(RoughnessMips, AreNeverRougherThanOneNorNaN) {
  std::mt19937 random(7);
  std::normal_distribution<double> any(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double steep = std::exp(3 * any(random));
    const double alpha = trial % 3 == 0 ? 0 : std::abs(std::sin(any(random)));
    Footprint sum;
    for (int i = 0; i < 1 + trial % 5; ++i) {
      sum.add(1, normalized({steep * any(random), steep * any(random), std::abs(any(random)) + 1e-12}),
              {alpha, alpha / 2, 90 * any(random)}, 0.9);
    }
    for (const MipRuleName& rule : kMipRules) {
      const MipTexel texel = filtered(sum, rule.rule);
      ASSERT_NEAR(length(texel.normal), 1, 1e-12) << rule.name;
      ASSERT_TRUE(texel.lobe.across <= 1 && texel.lobe.along <= texel.lobe.across && texel.lobe.along >= 0)
          << rule.name << ' ' << texel.lobe.across << ' ' << texel.lobe.along;
      ASSERT_TRUE(texel.lobe.azimuth_deg >= 0 && texel.lobe.azimuth_deg < 180) << texel.lobe.azimuth_deg;
    }
  }
}

TEST(RoughnessMips, HaveTheSizesOfGraphicsHardware) {
  const std::vector<MipLevel> mips = mips_of(level_surface({13, 5}));
  ASSERT_EQ(mips.size(), 3U);
  EXPECT_EQ(mips[0].normal.size(), (Size{6, 2}));
  EXPECT_EQ(mips[1].normal.size(), (Size{3, 1}));
  EXPECT_EQ(mips[2].normal.size(), (Size{1, 1}));
  EXPECT_TRUE(mips_of(level_surface({1, 1})).empty());
  EXPECT_EQ(mips_of(level_surface({1, 9})).back().normal.size(), (Size{1, 1}));
}

TEST(RoughnessMips, OfOddSizesCoverTheWholePicture) {
  const Surface ramp = made_surface({5, 1}, [](int x, int) { return std::array{0.1 * x, 0.0}; });
  const std::vector<MipLevel> mips = mips_of(ramp, {.weight = NormalWeight::kFacet});
  const auto slope = [](const MipLevel& level, int x) {
    return -level.normal(x, 0, 0) / level.normal(x, 0, 2);
  };
  // Two texels of two and a half pixels each.
  EXPECT_NEAR(slope(mips[0], 0), (0.0 + 0.1 + 0.5 * 0.2) / 2.5, 1e-6);
  EXPECT_NEAR(slope(mips[0], 1), (0.5 * 0.2 + 0.3 + 0.4) / 2.5, 1e-6);
  EXPECT_NEAR(slope(mips[1], 0), 0.2, 1e-6);
}

TEST(RoughnessMips, AreThoseOfTheirPixelsAtEveryLevel) {
  const Surface cloth = woven_surface({64, 64}, satin());
  for (const NormalWeight weight : {NormalWeight::kProjected, NormalWeight::kFacet}) {
    const MipLevel last =
        std::move(mips_of(cloth, {.rule = MipRule::kVmfYarns, .weight = weight, .alpha = 0.2}).back());
    Footprint all;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const Vec3 n = normalized({-double{cloth.slope(x, y, 0)}, -double{cloth.slope(x, y, 1)}, 1});
        all.add(weight == NormalWeight::kFacet ? 1 / n.z : 1, n, {0.2, 0.2, 0});
      }
    }
    const MipTexel texel = filtered(all, MipRule::kVmfYarns);
    EXPECT_NEAR(last.lobe(0, 0, 0), texel.lobe.across, 1e-6);
    EXPECT_NEAR(last.lobe(0, 0, 1), texel.lobe.along, 1e-6);
    EXPECT_NEAR(last.lobe(0, 0, 2), texel.lobe.azimuth_deg, 1e-3);
  }
}

TEST(RoughnessMips, HaveTheSameBytesForAnyNumberOfThreads) {
  const Surface cloth = woven_surface({101, 67}, satin());
  for (const MipRule rule : {MipRule::kVmfYarns, MipRule::kLengths}) {
    const std::vector<MipLevel> one = mips_of(cloth, {.rule = rule, .alpha = 0.2, .threads = 1});
    for (const int threads : {2, 7}) {
      const std::vector<MipLevel> many = mips_of(cloth, {.rule = rule, .alpha = 0.2, .threads = threads});
      ASSERT_EQ(one.size(), many.size());
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_TRUE(same_bytes(one[i].lobe, many[i].lobe) && same_bytes(one[i].normal, many[i].normal))
            << threads << " threads, level " << one[i].level;
        EXPECT_EQ(one[i].mean_alpha, many[i].mean_alpha);
      }
    }
  }
}

TEST(RoughnessMips, KeepTheWayThatYarnsLie) {
  for (const double azimuth_deg : {0.0, 30.0, 90.0, 140.0}) {
    const double a = radians(azimuth_deg);
    const Surface rolls = made_surface({64, 64}, [&](int x, int y) {
      const double across = -x * std::sin(a) - y * std::cos(a);  // y runs up the picture
      const double slope = 0.4 * std::sin(across);
      return std::array{-slope * std::sin(a), slope * std::cos(a)};
    });
    const MipLevel last = std::move(mips_of(rolls, {.rule = MipRule::kVmfYarns, .alpha = 0.15}).back());
    EXPECT_NEAR(last.lobe(0, 0, 1), 0.15, 0.002) << azimuth_deg;
    EXPECT_GT(last.lobe(0, 0, 0), 0.3) << azimuth_deg;
    const double off = std::remainder(double{last.lobe(0, 0, 2)} - azimuth_deg, 180.0);
    EXPECT_LT(std::abs(off), 2) << last.lobe(0, 0, 2) << " of " << azimuth_deg;
  }
}

TEST(RoughnessMips, OfASatinLieAlongItsFloatsWithinFiveDegrees) {
  const MipLevel last = std::move(
      mips_of(woven_surface({500, 500}, satin()), {.rule = MipRule::kVmfYarns, .alpha = 0.2}).back());
  const double off = std::abs(std::remainder(double{last.lobe(0, 0, 2)} - 90, 180.0));
  EXPECT_LT(off, 5) << "warp floats lie along y; found " << last.lobe(0, 0, 2);
  EXPECT_GT(last.lobe(0, 0, 0), 1.15 * last.lobe(0, 0, 1));
}

TEST(RoughnessMips, LeaveOutWhatHasNoSolutionAndHoles) {
  Surface surface = made_surface({8, 8}, [](int x, int) { return std::array{x < 4 ? 0.0 : 2.0, 0.0}; });
  for (int y = 0; y < 8; ++y) {
    for (int x = 4; x < 8; ++x) surface.status(x, y) = kNoSolution;
  }
  EXPECT_EQ(mips_of(surface, {.alpha = 0.1}).back().lobe(0, 0, 0), 0.1F);
  surface.status = Image<std::uint16_t>({8, 8});
  EXPECT_GT(mips_of(surface, {.alpha = 0.1}).back().lobe(0, 0, 0), 0.5F);
  surface.opacity = Image<float>({8, 8});
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 4; ++x) surface.opacity(x, y) = 1;
  }
  EXPECT_EQ(mips_of(surface, {.alpha = 0.1}).back().lobe(0, 0, 0), 0.1F);
}

TEST(RoughnessMips, WidenTheFinestLevelOfSamplesAndLeaveThatOfFacets) {
  const double bend = 0.2;  // of slope a pixel
  const Surface bowl = made_surface({9, 9}, [&](int x, int) { return std::array{bend * (x - 4), 0.0}; });
  const auto finest = [&](PixelMeaning pixels) {
    return std::move(
        mips_of(bowl, {.rule = MipRule::kClean, .pixels = pixels, .alpha = 0.1, .finest = 0}).front());
  };
  EXPECT_EQ(finest(PixelMeaning::kFacet).lobe(4, 4, 0), 0.1F);
  // Four samples across a pixel miss 1 / 16 of the variance.
  const double variance = bend * bend / 12 * (1 - 1.0 / 16);
  EXPECT_NEAR(finest(PixelMeaning::kSample).lobe(4, 4, 0), std::sqrt(0.01 + variance), 1e-6);
}

TEST(RoughnessMips, TellOneAlphaForAWholeLevel) {
  const Surface half = made_surface({8, 8}, [](int x, int y) {
    return std::array{x < 4 ? 0.0 : 0.5 * (y % 2 == 0 ? 1 : -1), 0.0};
  });
  const MipLevel level = std::move(mips_of(half, {.alpha = 0.1}).front());
  const double rough = double{level.lobe(3, 1, 0)}, smooth = double{level.lobe(0, 1, 0)};
  EXPECT_NEAR(level.mean_alpha, std::sqrt((rough * rough + smooth * smooth) / 2), 1e-7);
  EXPECT_GT(rough, 4 * smooth);
}

TEST(RoughnessMips, AreRefusedForAnAlphaThatIsNone) {
  for (const double alpha : {-0.1, 1.1, std::nan("")}) {
    EXPECT_FALSE(roughness_mips(level_surface({4, 4}), {.alpha = alpha})) << alpha;
  }
  EXPECT_FALSE(roughness_mips(level_surface({4, 4}), {.finest = -1}));
  EXPECT_FALSE(roughness_mips({}, {}));
}

}  // namespace
}  // namespace weft::material
