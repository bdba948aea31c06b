// SPDX-License-Identifier: Apache-2.0
#include "material/opacity/opacity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bench/oracles/mesh.h"
#include "core/solve/solve_record.h"
#include "tests/material/made_surface.h"

namespace weft::material {
namespace {

using Way = OpacityFacts::Way;

Image<float> even(Size size, float value) {
  Image<float> map(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) map(x, y) = value;
  }
  return map;
}

Opacity opacity_of_share(const Image<float>& share) {
  Result<Opacity> found = opacity_from_transmission({share.plane(), {}}, 1);
  EXPECT_TRUE(found) << (found ? "" : found.error().message());
  return found ? std::move(*found) : Opacity{};
}

struct OpacityError {
  double rms = 0, mean = 0;
};

OpacityError error_of(const Opacity& found, const Image<float>& truth) {
  double squares = 0, sum = 0;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const double off = double{found.map(x, y)} - double{truth(x, y)};
      squares += off * off;
      sum += off;
    }
  }
  const auto pixels = static_cast<double>(truth.size().pixels());
  return {std::sqrt(squares / pixels), sum / pixels};
}

TEST(Opacity, OfMeshAndLaceIsTheirCoverageToAHundredth) {
  for (const bool lace : {false, true}) {
    for (const auto& [through, back] :
         {std::pair{0.0, 0.0}, std::pair{0.08, 0.0}, std::pair{0.08, 0.25}, std::pair{0.2, 0.25}}) {
      const bench::RenderedMesh mesh = bench::rendered({.side_px = 96,
                                                        .pitch_px = 12,
                                                        .yarn_px = lace ? 6.0 : 5.0,
                                                        .is_lace = lace,
                                                        .through_yarns = through,
                                                        .thrown_back = back});
      const Opacity found = opacity_of_share(mesh.share);
      const OpacityError error = error_of(found, mesh.coverage);
      EXPECT_EQ(found.facts.way, Way::kCoverage) << lace << ' ' << through << ' ' << back;
      EXPECT_LT(error.rms, 0.01) << lace << ' ' << through << ' ' << back;
      EXPECT_LT(std::abs(error.mean), 0.005) << lace << ' ' << through << ' ' << back;
      EXPECT_NEAR(found.facts.through_yarns, through, 0.01);
    }
  }
}

TEST(Opacity, OfFinerClothCannotBeFoundAndIsTheLightThatCameThrough) {
  for (const bench::MeshScene& scene :
       {bench::MeshScene{
            .pitch_px = 6, .yarn_px = 2.5, .through_yarns = 0.08, .blur_px = 0.8, .defocus_px = 1.5},
        bench::MeshScene{.pitch_px = 4, .yarn_px = 2, .through_yarns = 0.2}}) {
    const bench::RenderedMesh mesh = bench::rendered(scene);
    const Opacity found = opacity_of_share(mesh.share);
    EXPECT_EQ(found.facts.way, Way::kTransmission) << scene.pitch_px << ": " << name_of(found.facts.way);
    EXPECT_FALSE(found.facts.is_coverage());
    EXPECT_NEAR(found.map(80, 80), std::clamp(1 - mesh.share(80, 80), 0.0F, 1.0F), 1e-6);
  }
}

TEST(Opacity, OfABareTableIsNothingAndOfBlackVelvetAll) {
  const Opacity bare = opacity_of_share(even({20, 20}, 1.0F)),
                velvet = opacity_of_share(even({20, 20}, 0.0F));
  EXPECT_EQ(bare.facts.way, Way::kBareTable);
  EXPECT_EQ(bare.map(7, 7), 0);
  EXPECT_EQ(velvet.facts.way, Way::kOpaque);
  EXPECT_EQ(velvet.map(7, 7), 1);
  EXPECT_EQ(opacity_of_share(even({20, 20}, 0.4F)).facts.way, Way::kTransmission)
      << "a thin sheet and a mesh finer than a pixel look the same";
}

TEST(Opacity, CountsWhatIsBeyondItsEndsAndWhatIsNoNumber) {
  bench::RenderedMesh mesh = bench::rendered({.thrown_back = 0.25});
  mesh.share(3, 3) = 1.4F;
  mesh.share(4, 90) = std::numeric_limits<float>::quiet_NaN();
  mesh.share(5, 20) = -std::numeric_limits<float>::infinity();
  const Opacity found = opacity_of_share(mesh.share);
  EXPECT_EQ(found.facts.way, Way::kCoverage);
  EXPECT_GE(found.facts.clipped, 1);
  EXPECT_EQ(found.facts.unreadable, 2);
  EXPECT_EQ(found.map(3, 3), 0);
  EXPECT_EQ(found.map(4, 90), 1);
  const Opacity nothing = opacity_of_share(even({4, 4}, std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(nothing.facts.unreadable, 16);
}

TEST(Opacity, IsRefusedWhereHolesAreSaturated) {
  const bench::RenderedMesh mesh = bench::rendered({});
  Image<std::uint8_t> saturated(mesh.share.size());
  saturated(0, 0) = 1;
  EXPECT_TRUE(opacity_from_transmission({mesh.share.plane(), saturated.plane()}));
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) saturated(x, y) = 1;
  }
  const Result<Opacity> refused = opacity_from_transmission({mesh.share.plane(), saturated.plane()});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("shorter exposure"), std::string::npos);
}

TEST(Opacity, WithoutALightBelowIsThatOfPatchesTheSolverCouldNotSee) {
  Image<std::uint16_t> status({40, 40});
  for (int y = 10; y < 16; ++y) {
    for (int x = 10; x < 16; ++x) status(x, y) = kDark;
  }
  status(30, 30) = kNoSolution;
  status(31, 31) = kNoSolution;
  const Opacity found = opacity_from_status(status.plane());
  EXPECT_EQ(found.facts.way, Way::kMarkedHoles);
  EXPECT_EQ(found.facts.holes, 36);
  EXPECT_EQ(found.map(12, 12), 0);
  EXPECT_EQ(found.map(30, 30), 1) << "pixels that failed are no hole";
  EXPECT_NEAR(found.facts.mean, 1 - 36.0 / 1600, 1e-12);
  EXPECT_EQ(opacity_from_status(status.plane(), {.bits = kDark, .least_pixels = 37}).facts.holes, 0);
}

TEST(RemoveTable, GivesBackTheClothOfARim) {
  // Cloth of albedo 0.5 and slope 0.4 over a table of 0.03, as Lambert's law adds both up.
  Surface seen = made_surface({5, 1}, [](int, int) { return std::array{0.4, 0.0}; });
  seen.opacity = Image<float>({5, 1});
  const std::array<double, 5> opacity = {1, 0.9, 0.6, 0.35, 0.2};
  const Vec3 n = normalized({-0.4, 0, 1});
  for (int x = 0; x < 5; ++x) {
    const double a = opacity[static_cast<std::size_t>(x)];
    const Vec3 b = (a * 0.5) * n + ((1 - a) * 0.03) * Vec3{0, 0, 1};
    seen.opacity(x, 0) = static_cast<float>(a);
    seen.slope(x, 0, 0) = static_cast<float>(-b.x / b.z);
    for (int c = 0; c < 3; ++c) seen.albedo(x, 0, c) = static_cast<float>(length(b));
  }
  EXPECT_LT(seen.albedo(2, 0, 0), 0.33F) << "seen with the table it is a third too dark";
  const Result<TableFacts> facts = remove_table(seen, {0.03, 0.03, 0.03}, 1);
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->unmixed, 3);
  EXPECT_EQ(facts->left, 1);
  for (int x = 0; x < 4; ++x) {
    EXPECT_NEAR(seen.albedo(x, 0, 1), 0.5, 1e-6) << x;
    EXPECT_NEAR(seen.slope(x, 0, 0), 0.4, 1e-6) << x;
  }
  EXPECT_NEAR(seen.sigma_deg(2, 0), 0.2 / 0.6, 1e-6);
  EXPECT_EQ(seen.sigma_deg(4, 0), 180);
  EXPECT_NE(seen.status(4, 0) & kNoSolution, 0);
}

TEST(RemoveTable, OfAMeshKeepsTheAlbedoOfRimsWithinThreePercent) {
  const bench::RenderedMesh mesh = bench::rendered({.through_yarns = 0.08});
  const Opacity found = opacity_of_share(mesh.share);
  Surface seen = made_surface({160, 160}, [](int, int) { return std::array{0.0, 0.0}; });
  seen.opacity = Image<float>({160, 160});
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 160; ++x) {
      const double a = double{mesh.coverage(x, y)};
      seen.opacity(x, y) = found.map(x, y);
      for (int c = 0; c < 3; ++c) seen.albedo(x, y, c) = static_cast<float>(0.5 * a + 0.03 * (1 - a));
    }
  }
  ASSERT_TRUE(remove_table(seen, {0.03, 0.03, 0.03}, 1));
  double sum = 0, count = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 160; ++x) {
      if (mesh.coverage(x, y) < 0.35F || mesh.coverage(x, y) > 0.95F) continue;
      sum += std::abs(double{seen.albedo(x, y, 0)} / 0.5 - 1);
      count += 1;
    }
  }
  ASSERT_GT(count, 1000);
  EXPECT_LT(sum / count, 0.03);
}

TEST(RemoveTable, IsRefusedWithoutOpacityAndForATableThatIsNone) {
  Surface surface = made_surface({4, 4}, [](int, int) { return std::array{0.0, 0.0}; });
  EXPECT_FALSE(remove_table(surface, {0.03, 0.03, 0.03}));
  surface.opacity = Image<float>({4, 4});
  EXPECT_FALSE(remove_table(surface, {0.03, std::nan(""), 0.03}));
}

TEST(OpacityMips, KeepTheCoverageThatMeansAloneLose) {
  const bench::RenderedMesh mesh = bench::rendered({.side_px = 128, .pitch_px = 12, .yarn_px = 3});
  const Result<std::vector<OpacityMip>> kept = opacity_mips(mesh.coverage.plane());
  const Result<std::vector<OpacityMip>> means = opacity_mips(mesh.coverage.plane(), {.keep_coverage = false});
  ASSERT_TRUE(kept && means);
  double finest = 0;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) finest += mesh.coverage(x, y) >= 0.5F;
  }
  finest /= 128 * 128;
  for (const std::size_t level : {0U, 1U, 2U, 3U}) {
    const auto texels = static_cast<double>((*kept)[level].map.size().pixels());
    EXPECT_NEAR((*kept)[level].coverage, finest, std::max(0.01, 2 / texels)) << "level " << level + 1;
  }
  EXPECT_GT(std::abs((*means)[3].coverage - finest), 0.2) << "a texel of 16 pixels holds more than a mesh";
}

TEST(OpacityMips, AreMeansOfWhatTheyCover) {
  Image<float> map({3, 1});
  map(1, 0) = 1;
  const Result<std::vector<OpacityMip>> mips = opacity_mips(map.plane(), {.keep_coverage = false});
  ASSERT_TRUE(mips);
  ASSERT_EQ(mips->size(), 1U);
  EXPECT_NEAR((*mips)[0].map(0, 0), 1.0 / 3, 1e-7);
  EXPECT_FALSE(opacity_mips(map.plane(), {.threshold = 1}));
  EXPECT_FALSE(opacity_mips({}));
}

}  // namespace
}  // namespace weft::material
