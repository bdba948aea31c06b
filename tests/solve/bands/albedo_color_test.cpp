// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/albedo_color.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace weft::solve {
namespace {

constexpr std::array<float, 3> kDyeAlbedo = {0.2F, 0.5F, 0.3F}, kDyeSigma = {0.01F, 0.02F, 0.03F};
const Mat3 kMatrix = {{{1.6, -0.5, -0.1}, {-0.3, 1.5, -0.2}, {0.1, -0.7, 1.6}}};

// A band of one row of even albedo, with the share of the calibration in each channel.
class Band {
 public:
  Band() : albedo_({4, 1}, 3), sigma_({4, 1}, 3), shares_({4, 1}, 4) {
    for (int x = 0; x < 4; ++x) {
      for (int c = 0; c < 3; ++c) {
        albedo_(x, 0, c) = kDyeAlbedo[static_cast<std::size_t>(c)];
        sigma_(x, 0, c) = kDyeSigma[static_cast<std::size_t>(c)];
        shares_(x, 0, c) = 0.1F * kDyeAlbedo[static_cast<std::size_t>(c)];
      }
    }
    band_.albedo_rows = {0, 0, 4, 1};
    band_.albedo = {albedo_.plane(0), albedo_.plane(1), albedo_.plane(2)};
    band_.sigma_albedo = {sigma_.plane(0), sigma_.plane(1), sigma_.plane(2)};
  }
  const MapBand& band() const { return band_; }
  std::vector<View<const float>> shares() const {
    return {shares_.plane(0), shares_.plane(1), shares_.plane(2), shares_.plane(3)};
  }

 private:
  Image<float> albedo_, sigma_, shares_;
  MapBand band_;
};

TEST(AlbedoColor, OfAMatrixIsTheMatrixAndItsSigmaTheRootOfTheSquares) {
  const Band camera;
  AlbedoColor color({.rec709_from_camera = kMatrix, .covariance = {}, .curve = {}}, 4, 1);
  std::vector<View<const float>> none;
  const MapBand band = color.of(camera.band(), none);
  EXPECT_TRUE(none.empty()) << "nothing is known of the calibration";
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& row = kMatrix[c];
    EXPECT_FLOAT_EQ(band.albedo[c](3, 0), static_cast<float>(row[0] * kDyeAlbedo[0] + row[1] * kDyeAlbedo[1] +
                                                             row[2] * kDyeAlbedo[2]));
    EXPECT_FLOAT_EQ(
        band.sigma_albedo[c](3, 0),
        static_cast<float>(std::hypot(row[0] * kDyeSigma[0], row[1] * kDyeSigma[1], row[2] * kDyeSigma[2])));
  }
}

TEST(AlbedoColor, OfTheModelsSigmaMovesAllChannelsTogether) {
  const Band camera;
  MapBand band = camera.band();
  const std::vector<View<const float>> shares = camera.shares();
  band.model_albedo = {shares[0], shares[1], shares[2]};
  AlbedoColor color({.rec709_from_camera = kMatrix, .covariance = {}, .curve = {}}, 4, 1);
  std::vector<View<const float>> none;
  const MapBand rec709 = color.of(band, none);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(rec709.model_albedo[c](3, 0), 0.1F * std::abs(rec709.albedo[c](3, 0)), 1e-6F) << c;
  }
}

TEST(AlbedoColor, OfTheSigmaOfLightsMovesAllChannelsTogether) {
  const Band camera;
  AlbedoColor color({.rec709_from_camera = kMatrix, .covariance = {}, .curve = {}}, 4, 1);
  std::vector<View<const float>> shares = camera.shares();
  const float* normal_deg = shares[3].row(0);
  const MapBand band = color.of(camera.band(), shares);
  ASSERT_EQ(shares.size(), 4U);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(shares[c](1, 0), 0.1 * std::abs(band.albedo[c](1, 0)), 1e-7)
        << "a tenth of each channel is a tenth of the colour";
  }
  EXPECT_EQ(shares[3].row(0), normal_deg) << "the angle of the normal has no colour";
}

TEST(AlbedoColor, OfAMatrixWithACovarianceHasThatVarianceToo) {
  const Band camera;
  std::vector<double> covariance(81);
  for (std::size_t i = 0; i < 9; ++i) covariance[10 * i] = 1e-4;  // each entry within 0.01
  covariance[1] = covariance[9] = 5e-5;                           // the first two of red go together
  AlbedoColor color({.rec709_from_camera = kMatrix, .covariance = covariance, .curve = {}}, 4, 1);
  EXPECT_TRUE(color.has_covariance());
  const double length = std::hypot(kDyeAlbedo[0], kDyeAlbedo[1], kDyeAlbedo[2]);

  std::vector<View<const float>> alone;
  color.of(camera.band(), alone);
  ASSERT_EQ(alone.size(), 3U);
  EXPECT_NEAR(alone[1](0, 0), 0.01 * length, 1e-8);
  EXPECT_NEAR(alone[0](0, 0), std::sqrt(1e-4 * length * length + 2 * 5e-5 * kDyeAlbedo[0] * kDyeAlbedo[1]),
              1e-8);

  std::vector<View<const float>> with_lights = camera.shares();
  const MapBand band = color.of(camera.band(), with_lights);
  EXPECT_NEAR(with_lights[1](0, 0), std::hypot(0.01 * length, 0.1 * band.albedo[1](0, 0)), 1e-8);
}

TEST(AlbedoColor, OfACurveHasTheSlopeOfTheCurve) {
  // Luminance squared, chromaticity as it was: X, Y and Z times Y, so that every channel is c Y.
  const ColorCurve square = {.before = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                             .cubic = {0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                             .after = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
  const Band camera;
  AlbedoColor color({.rec709_from_camera = {}, .covariance = {}, .curve = square}, 4, 1);
  std::vector<View<const float>> none;
  const MapBand band = color.of(camera.band(), none);
  constexpr std::array<double, 3> kLuminance = {0.2126, 0.7152, 0.0722};
  const double y =
      kLuminance[0] * kDyeAlbedo[0] + kLuminance[1] * kDyeAlbedo[1] + kLuminance[2] * kDyeAlbedo[2];
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(band.albedo[c](2, 0), kDyeAlbedo[c] * y, 1e-4);
    double square_sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double slope = (k == c ? y : 0) + kDyeAlbedo[c] * kLuminance[k];
      square_sum += slope * slope * kDyeSigma[k] * kDyeSigma[k];
    }
    EXPECT_NEAR(band.sigma_albedo[c](2, 0), std::sqrt(square_sum), 1e-4 * std::sqrt(square_sum) + 1e-6)
        << "channel " << c;
  }
}

TEST(AlbedoColor, KeepsAlbedoBelowZero) {
  Image<float> dark({1, 1}, 3), sigma({1, 1}, 3);
  dark(0, 0, 0) = -0.1F;
  MapBand camera;
  camera.albedo_rows = {0, 0, 1, 1};
  camera.albedo = {dark.plane(0), dark.plane(1), dark.plane(2)};
  camera.sigma_albedo = {sigma.plane(0), sigma.plane(1), sigma.plane(2)};
  AlbedoColor color({.rec709_from_camera = kMatrix, .covariance = {}, .curve = {}}, 1, 1);
  std::vector<View<const float>> none;
  EXPECT_FLOAT_EQ(color.of(camera, none).albedo[0](0, 0), -0.16F);
}

}  // namespace
}  // namespace weft::solve
