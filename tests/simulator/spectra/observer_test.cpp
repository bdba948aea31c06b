// SPDX-License-Identifier: Apache-2.0
#include "simulator/spectra/observer.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "tests/simulator/spectra/tables.h"

namespace weft::simulator {
namespace {

using Table = Eigen::Matrix<double, Eigen::Dynamic, 3>;

Spectrum table(const std::string& name) {
  const auto spectrum = read_spectrum(kTables / name);
  EXPECT_TRUE(spectrum) << spectrum.error().message();
  return spectrum ? *spectrum : flat_spectrum(1);
}

Filters filters() {
  return {table("filter_red.txt"), table("filter_green.txt"), table("filter_blue.txt")};
}

ChannelWeights camera() {
  const auto weights = camera_weights(table("led_white.txt"), filters());
  EXPECT_TRUE(weights) << weights.error().message();
  return weights ? *weights : ChannelWeights{};
}

std::vector<Spectrum> chart() {
  const auto spectra = read_spectra(kTables / "chart", 24);
  EXPECT_TRUE(spectra) << spectra.error().message();
  return spectra ? *spectra : std::vector<Spectrum>(24);
}

std::vector<Spectrum> dyes() {
  std::vector<Spectrum> spectra;
  for (const char* name :
       {"black", "cochineal", "green", "indigo", "madder", "pale_indigo", "undyed_cotton", "walnut", "weld"})
    spectra.push_back(table("dye/" + std::string(name) + ".txt"));
  return spectra;
}

Table seen(const ChannelWeights& weights, const std::vector<Spectrum>& surfaces) {
  Table rows(surfaces.size(), 3);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Rgb rgb = channel_reflectance(weights, surfaces[i]);
    rows.row(static_cast<Eigen::Index>(i)) << rgb[0], rgb[1], rgb[2];
  }
  return rows;
}

/// The best linear map from what the camera sees of the chart to its albedo.
Eigen::Matrix3d best_map() {
  return seen(camera(), chart()).colPivHouseholderQr().solve(seen(rec709_weights(), chart()));
}

/// Rms of what a linear map leaves over the rms of the albedo.
double residual(const Eigen::Matrix3d& map, const std::vector<Spectrum>& surfaces) {
  const Table albedo = seen(rec709_weights(), surfaces);
  return (seen(camera(), surfaces) * map - albedo).norm() / albedo.norm();
}

double srgb8(double linear) {
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

std::array<double, 2> uv_of(std::array<double, 2> xy) {
  const double below = -2 * xy[0] + 12 * xy[1] + 3;
  return {4 * xy[0] / below, 9 * xy[1] / below};
}

/// CIE daylight of a colour temperature from 4000 to 7000 K (Judd et al. 1964).
std::array<double, 2> daylight(double kelvin) {
  const double t = 1e3 / kelvin;
  const double x = ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063;
  return {x, (-3 * x + 2.87) * x - 0.275};
}

TEST(Observer, GivesAFlatReflectanceItsValueInEveryChannel) {
  for (const double value : {0.0, 0.18, 0.5, 1.0}) {
    const Rgb by_camera = channel_reflectance(camera(), flat_spectrum(value));
    const Rgb by_eye = rec709_albedo(flat_spectrum(value));
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(by_camera[c], value, 1e-14);
      EXPECT_NEAR(by_eye[c], value, 1e-14);
    }
  }
}

TEST(Observer, SeesEqualEnergyWhereCieHasIt) {
  // The fit is good to about 0.002 in x and y.
  const auto equal = chromaticity(flat_spectrum(1));
  EXPECT_NEAR(equal[0], 1.0 / 3, 0.003);
  EXPECT_NEAR(equal[1], 1.0 / 3, 0.003);
}

TEST(Observer, MakesOneWavelengthAColourOutsideRec709) {
  Spectrum cyan;
  cyan.samples[(500 - Spectrum::kFirst_nm) / Spectrum::kStep_nm] = 1;
  const Rgb albedo = rec709_albedo(cyan);
  EXPECT_LT(albedo[0], -0.005);
  EXPECT_GT(albedo[1], 0.005);
}

TEST(Observer, IsNoLinearMapOfTheCamera) {
  // 2.1 percent: a camera with a good but not a perfect set of filters.
  const double left = residual(best_map(), chart());
  EXPECT_GT(left, 0.005) << "share of the albedo's rms";
  EXPECT_LT(left, 0.05);
  // The map made from the chart is about as good on cloth, which has other curves: 1.8 percent.
  const double left_on_cloth = residual(best_map(), dyes());
  EXPECT_GT(left_on_cloth, 0.005);
  EXPECT_LT(left_on_cloth, 0.05);
}

TEST(Observer, GivesTheChartItsKnownColours) {
  struct Patch {
    std::size_t number;
    std::array<double, 3> srgb;
  };
  const auto patches = chart();
  for (const Patch& patch : {Patch{1, {115, 82, 68}}, Patch{6, {103, 189, 170}}, Patch{13, {56, 61, 150}},
                             Patch{15, {175, 54, 60}}, Patch{16, {231, 199, 31}}, Patch{18, {8, 133, 161}},
                             Patch{19, {243, 243, 242}}, Patch{24, {52, 52, 52}}}) {
    const Rgb albedo = rec709_albedo(patches[patch.number - 1]);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(srgb8(albedo[c]), patch.srgb[c], 0.1) << "patch " << patch.number << ", channel " << c;
  }
}

TEST(Observer, SeesTheLedAsDaylightOfAbout6500K) {
  const auto led = uv_of(chromaticity(table("led_white.txt")));
  double nearest_kelvin = 0;
  double distance = 1;
  for (double kelvin = 5000; kelvin <= 7000; kelvin += 10) {
    const auto locus = uv_of(daylight(kelvin));
    const double d = std::hypot(led[0] - locus[0], led[1] - locus[1]);
    if (d < distance) {
      distance = d;
      nearest_kelvin = kelvin;
    }
  }
  EXPECT_LT(distance, 0.002) << "in u'v'";
  EXPECT_NEAR(nearest_kelvin, 6500, 200);
}

TEST(Camera, SeesTheWhiteLedGreenerThanRedOrBlue) {
  const auto balance = camera_white_balance(table("led_white.txt"), filters());
  ASSERT_TRUE(balance) << balance.error().message();
  EXPECT_NEAR((*balance)[0], 0.5, 0.05);
  EXPECT_EQ((*balance)[1], 1);
  EXPECT_NEAR((*balance)[2], 0.68, 0.05);
}

TEST(Camera, IsRefusedWhereAFilterPassesNothingOfTheLed) {
  Filters blind = filters();
  blind[2] = flat_spectrum(0);
  const auto weights = camera_weights(table("led_white.txt"), blind);
  ASSERT_FALSE(weights);
  EXPECT_EQ(weights.error().kind, ErrorKind::kBadData);
  EXPECT_NE(weights.error().why.find("channel B"), std::string::npos) << weights.error().why;
  EXPECT_FALSE(camera_white_balance(flat_spectrum(0), filters()));
}

}  // namespace
}  // namespace weft::simulator
