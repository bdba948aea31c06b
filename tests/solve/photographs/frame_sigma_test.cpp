// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/frame_sigma.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/base/statistics.h"
#include "solve/bands/sigma_channels.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kSigmaSize = {96, 150};  // two whole bands and a part of one
constexpr std::uint32_t kNoiseSeed = 7;

/// Sigma of a solve and its normals, in memory.
struct Sigmas {
  Image<float> normal{kSigmaSize, 3}, noise_deg{kSigmaSize}, model_deg{kSigmaSize}, model_red{kSigmaSize},
      albedo_red{kSigmaSize};

  double median_of(const Image<float>& map) const {
    std::vector<double> values;
    for (int y = 0; y < kSigmaSize.height; ++y) {
      for (int x = 0; x < kSigmaSize.width; ++x) values.push_back(static_cast<double>(map(x, y)));
    }
    return median(std::move(values));
  }
};

Sigmas sigmas_of(const Photographs& photographs, const TileOptions& tile = kSolveTile, int threads = 1,
                 const solver::ModelTraits& traits = {}) {
  Sigmas sigmas;
  const auto keep = [&](const MapBand& band) -> Result<void> {
    for (int y = 0; y < band.rows.height(); ++y) {
      for (int c = 0; c < 3; ++c) {
        std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), kSigmaSize.width,
                    sigmas.normal.plane(c).row(band.rows.y0 + y));
      }
    }
    for (int y = 0; y < band.albedo_rows.height(); ++y) {
      const int row = band.albedo_rows.y0 + y;
      std::copy_n(band.sigma_normal_deg.row(y), kSigmaSize.width, sigmas.noise_deg.plane().row(row));
      std::copy_n(band.model_normal_deg.row(y), kSigmaSize.width, sigmas.model_deg.plane().row(row));
      std::copy_n(band.model_albedo[0].row(y), kSigmaSize.width, sigmas.model_red.plane().row(row));
      std::copy_n(band.albedo[0].row(y), kSigmaSize.width, sigmas.albedo_red.plane().row(row));
    }
    return {};
  };
  const auto ok =
      solve_bands(photographs, *solver::fast_method(), tile, {.threads = threads}, keep, {.model = traits});
  EXPECT_TRUE(ok) << ok.error().message();
  return sigmas;
}

// Mosaics with the noise of their own model.
Photographs noisy_mosaics(const Cloth& cloth) {
  Photographs photographs = mosaics(kSigmaSize, cloth);
  Mosaics& frames = *photographs.mosaics();
  frames.noise = {.per_reading = 1e-5, .floor = 1e-7};
  std::mt19937 random(kNoiseSeed);
  std::normal_distribution<double> normal;
  for (RawFrame& frame : frames.frames) {
    for (int y = 0; y < kSigmaSize.height; ++y) {
      for (int x = 0; x < kSigmaSize.width; ++x) {
        const double reading = (frame.counts(x, y) - kBlack) / kRange;
        const double with_noise = reading + std::sqrt(frames.noise.variance(reading)) * normal(random);
        frame.counts(x, y) = static_cast<std::uint16_t>(std::lround(kBlack + kRange * with_noise));
      }
    }
  }
  return photographs;
}

TEST(ModelPart, IsSmallOnALevelClothThatNoiseAloneDisturbs) {
  const Sigmas sigmas = sigmas_of(noisy_mosaics({}));
  const double noise = sigmas.median_of(sigmas.noise_deg), model = sigmas.median_of(sigmas.model_deg);
  EXPECT_NEAR(noise, 0.15, 0.03);
  EXPECT_LT(model, 0.15 * noise) << "noise " << noise << " degrees, seed " << kNoiseSeed;
}

TEST(ModelPart, IsAsLargeAsTheErrorThatAWrongLightMakes) {
  Photographs photographs = noisy_mosaics({.normal = wave});
  RawFrame& brighter = photographs.mosaics()->frames[0];
  for (int y = 0; y < kSigmaSize.height; ++y) {
    for (int x = 0; x < kSigmaSize.width; ++x) {
      brighter.counts(x, y) =
          static_cast<std::uint16_t>(std::lround(kBlack + 1.15 * (brighter.counts(x, y) - kBlack)));
    }
  }
  const Sigmas sigmas = sigmas_of(photographs);
  std::vector<double> errors;
  for (int y = 0; y < kSigmaSize.height; ++y) {
    for (int x = 0; x < kSigmaSize.width; ++x) {
      errors.push_back(
          angle_deg({sigmas.normal(x, y, 0), sigmas.normal(x, y, 1), sigmas.normal(x, y, 2)}, wave(x, y)));
    }
  }
  const double error = median(std::move(errors)), model = sigmas.median_of(sigmas.model_deg);
  EXPECT_GT(model, 0.5 * error) << "error " << error;
  EXPECT_LT(model, 2 * error) << "error " << error;
}

TEST(ModelPart, CountsLightFromSteepPaleClothThatShowsInNoResidual) {
  const auto model = [](double albedo, const solver::ModelTraits& traits) {
    const Sigmas sigmas =
        sigmas_of(noisy_mosaics({.normal = wave, .albedo = {albedo, albedo, albedo}}), kSolveTile, 1, traits);
    return sigmas.median_of(sigmas.model_deg);
  };
  const double pale = model(0.9, {}), grey = model(0.3, {});
  EXPECT_NEAR(pale / grey, 3, 0.5) << pale << " and " << grey << " degrees";
}

TEST(ModelPart, DoesNotDependOnTilesOrThreads) {
  const Photographs photographs = noisy_mosaics({.normal = wave});
  const Sigmas whole = sigmas_of(photographs), tiled = sigmas_of(photographs, {.width = 64, .height = 7}, 2);
  for (int y = 0; y < kSigmaSize.height; ++y) {
    for (int x = 0; x < kSigmaSize.width; ++x) {
      ASSERT_EQ(whole.model_deg(x, y), tiled.model_deg(x, y)) << x << ' ' << y;
      ASSERT_EQ(whole.model_red(x, y), tiled.model_red(x, y)) << x << ' ' << y;
    }
  }
}

TEST(ModelPart, OfDevelopedPhotographsCountsLightFromTheClothAlone) {
  const Sigmas sigmas = sigmas_of(developed(kSigmaSize, {.normal = wave}));
  EXPECT_GT(sigmas.median_of(sigmas.model_deg), 0.05);
  EXPECT_LT(sigmas.median_of(sigmas.model_deg), 1);
}

TEST(ModelPart, OfAPreviewIsLargeInAFoldAndSmallOnTheYarnsBeside) {
  constexpr int kFold = 48;
  const auto roofs = [](int x, int) {
    const double slope = x < kFold ? -0.35 : x > kFold ? 0.35 : 0;  // a furrow, whose pixel mixes both sides
    return normalized(Vec3{-slope, 0, 1});
  };
  const Sigmas sigmas = sigmas_of(developed(kSigmaSize, {.normal = roofs}), kSolveTile, 1, {.is_half = true});
  const float fold = sigmas.model_deg(kFold, 30), beside = sigmas.model_deg(kFold - 8, 30);
  EXPECT_NEAR(static_cast<double>(fold), degrees(std::atan(0.35)), 4) << "beside it " << beside;
  EXPECT_LT(beside, 0.4F * fold);
}

TEST(SigmaChannels, AreTheRootOfTheSumOfTheSquaresOfTheirParts) {
  Image<float> parts({3, 1}, 12);
  for (int p = 0; p < parts.planes(); ++p) std::fill_n(parts.plane(p).row(0), 3, static_cast<float>(p + 1));
  parts(2, 0, 3) = 180;
  MapBand band;
  band.albedo_rows = {0, 0, 3, 1};
  band.sigma_albedo = {parts.plane(0), parts.plane(1), parts.plane(2)};
  band.sigma_normal_deg = parts.plane(3);
  band.model_albedo = {parts.plane(4), parts.plane(5), parts.plane(6)};
  band.model_normal_deg = parts.plane(7);
  const std::vector<View<const float>> calibration = {parts.plane(8), parts.plane(9), parts.plane(10),
                                                      parts.plane(11)};
  const std::vector<std::string> of = {"R", "G", "B", "normal_deg"};
  SigmaChannels with(3, of), without(3, {});
  const auto all = with.of(band, calibration), two = without.of(band, {});
  ASSERT_EQ(all.size(), with.names().size());
  ASSERT_EQ(two.size(), without.names().size());
  for (std::size_t c = 0; c < of.size(); ++c) {
    const auto n = static_cast<float>(c);
    EXPECT_EQ(with.names()[c], of[c]);
    EXPECT_FLOAT_EQ(all[c](0, 0), std::hypot(n + 1, n + 5, n + 9)) << of[c];
    EXPECT_FLOAT_EQ(two[c](0, 0), std::hypot(n + 1, n + 5)) << of[c];
    EXPECT_EQ(with.names()[c + 4], of[c] + ".noise");
    EXPECT_EQ(all[c + 4](0, 0), n + 1);
    EXPECT_EQ(with.names()[c + 8], of[c] + ".model");
    EXPECT_EQ(all[c + 8](0, 0), n + 5);
    EXPECT_EQ(with.names()[c + 12], of[c] + ".calibration");
    EXPECT_EQ(all[c + 12](0, 0), n + 9);
  }
  EXPECT_EQ(all[kSumOfAngle](2, 0), 180) << "an angle is 180 degrees at most";
}

}  // namespace
}  // namespace weft::solve
