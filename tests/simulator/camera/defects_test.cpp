// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/defects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/simulator/camera/frame.h"

namespace weft::simulator {
namespace {

constexpr std::array<std::uint32_t, 2> kKey = {11, 0};

std::vector<PhotositeDefect> photosites(const DefectSettings& settings, Rect rect) {
  std::vector<PhotositeDefect> sites(static_cast<std::size_t>(rect.pixels()));
  SensorPattern(settings, kKey).fill(rect, sites);
  return sites;
}

double deviation(const std::vector<double>& values) {
  double sum = 0, sum_of_squares = 0;
  for (const double v : values) sum += v, sum_of_squares += v * v;
  const auto n = static_cast<double>(values.size());
  return std::sqrt(sum_of_squares / n - sum / n * sum / n);
}

DefectSettings everything() {
  DefectSettings settings;
  settings.dark_electrons_per_s = 5;
  settings.response_percent = 1;
  settings.column_counts = 2;
  settings.photosite_counts = 3;
  settings.cell_counts = {{{0, 1}, {2, 3}}};
  settings.hot_per_million = 20000;
  settings.dead_per_million = 10000;
  settings.dead_response = 0.3;
  return settings;
}

TEST(SensorPattern, OfAnIdealSensorIsNone) {
  for (const PhotositeDefect& site : photosites({}, {0, 0, 50, 50})) {
    ASSERT_EQ(site.response, 1);
    ASSERT_EQ(site.dark_electrons_per_s, 0);
    ASSERT_EQ(site.offset_counts, 0);
  }
  EXPECT_TRUE(SensorPattern({}, kKey).defects({50, 50}).empty());
}

TEST(SensorPattern, IsTheSameInEveryTile) {
  const Rect whole = {0, 0, 64, 48};
  const std::vector<PhotositeDefect> all = photosites(everything(), whole);
  for (const Rect& part : {Rect{0, 0, 7, 5}, Rect{31, 11, 64, 48}}) {
    const std::vector<PhotositeDefect> some = photosites(everything(), part);
    std::size_t i = 0;
    for (int y = part.y0; y < part.y1; ++y)
      for (int x = part.x0; x < part.x1; ++x, ++i) {
        const PhotositeDefect& same = all[index(y * whole.width() + x)];
        ASSERT_EQ(some[i].response, same.response);
        ASSERT_EQ(some[i].dark_electrons_per_s, same.dark_electrons_per_s);
        ASSERT_EQ(some[i].offset_counts, same.offset_counts);
      }
  }
}

TEST(SensorPattern, ScattersResponseAndBlackLevelAsItsSettingsSay) {
  const Rect rect = {0, 0, 200, 100};
  const double four_errors = 4 / std::sqrt(2.0 * 20000);
  std::vector<double> response, offset;
  for (const PhotositeDefect& site : photosites({.response_percent = 2, .photosite_counts = 5}, rect)) {
    response.push_back(site.response);
    offset.push_back(site.offset_counts);
  }
  EXPECT_NEAR(deviation(response), 0.02, 0.02 * four_errors);
  EXPECT_NEAR(deviation(offset), 5, 5 * four_errors);
}

TEST(SensorPattern, OffsetsWholeColumnsAndFilterCells) {
  const Rect rect = {0, 0, 4000, 4};
  const auto sites = photosites({.column_counts = 3, .cell_counts = {{{0, 10}, {20, 30}}}}, rect);
  std::vector<double> columns;
  for (std::size_t x = 0; x < 4000; ++x) {
    columns.push_back(sites[x].offset_counts - (x % 2 == 0 ? 0 : 10));
    for (std::size_t y = 1; y < 4; ++y)
      ASSERT_NEAR(sites[y * 4000 + x].offset_counts - sites[x].offset_counts, y % 2 == 0 ? 0 : 20, 1e-12);
  }
  EXPECT_NEAR(deviation(columns), 3, 3 * 4 / std::sqrt(2.0 * 4000));
}

TEST(SensorPattern, DoublesItsDarkCurrentWithWarmth) {
  DefectSettings settings = {.dark_electrons_per_s = 3, .temperature_c = 43, .dark_doubling_c = 6};
  EXPECT_DOUBLE_EQ(photosites(settings, {5, 5, 6, 6})[0].dark_electrons_per_s, 24);
  settings.temperature_c = 19;
  EXPECT_DOUBLE_EQ(photosites(settings, {5, 5, 6, 6})[0].dark_electrons_per_s, 1.5);
}

TEST(SensorPattern, ListsTheDefectsThatItsPhotositesShow) {
  const Size size = {300, 200};
  const auto defects = SensorPattern(everything(), kKey).defects(size);
  const auto sites = photosites(everything(), {0, 0, 300, 200});
  std::vector<DefectivePhotosite> shown;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const PhotositeDefect& site = sites[index(y * size.width + x)];
      if (site.dark_electrons_per_s > 5) {
        shown.push_back({x, y, DefectKind::kHot});
        EXPECT_GT(site.dark_electrons_per_s, 5000);
        EXPECT_LT(site.dark_electrons_per_s, 15006);
      }
      if (site.response < 0.5) shown.push_back({x, y, DefectKind::kDead});
    }
  EXPECT_EQ(shown, defects);
  const auto hot =
      static_cast<double>(std::ranges::count(defects, DefectKind::kHot, &DefectivePhotosite::kind));
  EXPECT_NEAR(hot, 1200, 4 * std::sqrt(1200.0));
  EXPECT_NEAR(static_cast<double>(defects.size()) - hot, 600, 4 * std::sqrt(600.0));
}

TEST(Expose, AddsTheDarkChargeOfTheExposureToTheLight) {
  const std::vector<PhotositeDefect> sites = {{1, 0, 0}, {0.5, 100, 0}, {0, 4000, 0}};
  std::vector<double> samples = {0.2, 0.4, 0.6};
  expose(sites, 0.25, 10000, samples);
  EXPECT_DOUBLE_EQ(samples[0], 0.2);
  EXPECT_DOUBLE_EQ(samples[1], 0.2 + 25 / 10000.0);
  EXPECT_DOUBLE_EQ(samples[2], 0.1);
}

TEST(BlackPattern, ShiftsSamplesByCounts) {
  const std::vector<PhotositeDefect> sites = {{1, 0, 0}, {1, 0, 3}, {1, 0, -6}};
  std::vector<double> samples = {0.5, 0.5, 0};
  add_black_pattern(sites, 3000, samples);
  EXPECT_DOUBLE_EQ(samples[0], 0.5);
  EXPECT_DOUBLE_EQ(samples[1], 0.501);
  EXPECT_DOUBLE_EQ(samples[2], -0.002);
}

}  // namespace
}  // namespace weft::simulator
