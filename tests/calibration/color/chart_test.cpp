// SPDX-License-Identifier: Apache-2.0
#include "calibration/color/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/vec.h"

namespace weft::calibration {
namespace {

using testing::HasSubstr;

// A chart of patches 1.1 sides apart in a black frame, turned and as large as asked for, on grey.
struct Drawn {
  Size size = {640, 480};
  double angle = radians(5), pitch_px = 80;
  bool mirrored = false;
  Image<float> rgb;
  ChartCorners corners = {};

  void draw() {
    rgb = Image<float>(size, 3);
    const ChartReference chart = published_chart();
    const double side = kPatchShare * pitch_px, frame = 0.2 * pitch_px;
    const double width = 5 * pitch_px + side, height = 3 * pitch_px + side;
    const double c = std::cos(angle), s = std::sin(angle), flip = mirrored ? -1 : 1;
    const auto pixel = [&](double u, double v) {
      const double x = flip * (u - width / 2), y = v - height / 2;
      return std::array<double, 2>{size.width / 2.0 + c * x - s * y, size.height / 2.0 + s * x + c * y};
    };
    corners = {pixel(0, 0), pixel(width, 0), pixel(width, height), pixel(0, height)};
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double dx = x - size.width / 2.0, dy = y - size.height / 2.0;
        const double u = flip * (c * dx + s * dy) + width / 2, v = -s * dx + c * dy + height / 2;
        Rgb colour = {0.3, 0.3, 0.3};
        if (u > -frame && v > -frame && u < width + frame && v < height + frame) colour = {0.01, 0.01, 0.01};
        const double i = std::floor(u / pitch_px), j = std::floor(v / pitch_px);
        const bool inside =
            i >= 0 && j >= 0 && i < 6 && j < 4 && u - i * pitch_px < side && v - j * pitch_px < side;
        if (inside) colour = chart[static_cast<std::size_t>(6 * j + i)];
        for (int p = 0; p < 3; ++p) {
          rgb(x, y, p) = static_cast<float>(0.8 * std::max(colour[static_cast<std::size_t>(p)], 0.0));
        }
      }
    }
  }
};

TEST(Chart, IsFoundAndReadPatchByPatch) {
  Drawn drawn;
  drawn.draw();
  const auto corners = find_chart(drawn.rgb);
  ASSERT_TRUE(corners) << corners.error().message();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR((*corners)[i][0], drawn.corners[i][0], 0.12 * drawn.pitch_px) << "corner " << i;
    EXPECT_NEAR((*corners)[i][1], drawn.corners[i][1], 0.12 * drawn.pitch_px) << "corner " << i;
  }
  const auto patches = read_patches(drawn.rgb, *corners);
  ASSERT_TRUE(patches) << patches.error().message();
  const ChartReference chart = published_chart();
  for (std::size_t i = 0; i < chart.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR((*patches)[i].mean[c], 0.8 * std::max(chart[i][c], 0.0), 1e-6) << "patch " << i + 1;
    }
    EXPECT_LT((*patches)[i].unevenness, 1e-6);
    EXPECT_EQ((*patches)[i].full_share, 0);
  }
  EXPECT_EQ(side_of(*patches, chart), ChartSide::kUpright);
}

TEST(Chart, IsReadByItsCornersWhereverTheyAre) {
  Drawn drawn;
  drawn.angle = radians(-32);
  drawn.pitch_px = 50;
  drawn.draw();
  const auto patches = read_patches(drawn.rgb, drawn.corners);
  ASSERT_TRUE(patches) << patches.error().message();
  EXPECT_EQ(side_of(*patches, published_chart()), ChartSide::kUpright);
  EXPECT_NEAR((*patches)[18].mean[1], 0.8 * published_chart()[18][1], 1e-6);
}

TEST(Chart, ThatLiesUpsideDownOrMirroredIsKnown) {
  Drawn drawn;
  drawn.draw();
  const ChartCorners& c = drawn.corners;
  const auto turned = read_patches(drawn.rgb, {c[2], c[3], c[0], c[1]});
  ASSERT_TRUE(turned);
  EXPECT_EQ(side_of(*turned, published_chart()), ChartSide::kUpsideDown);
  const auto mirrored = read_patches(drawn.rgb, {c[1], c[0], c[3], c[2]});
  ASSERT_TRUE(mirrored);
  EXPECT_EQ(side_of(*mirrored, published_chart()), ChartSide::kMirrored);
}

TEST(Chart, IsNotSeenInStripes) {
  std::vector<PatchReading> patches(kChartPatches);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const double v = i % 2 == 0 ? 0.8 : 0.1;
    patches[i].mean = {v, v, v};
  }
  EXPECT_EQ(side_of(patches, published_chart()), ChartSide::kNoChart);
  Image<float> grey({400, 300}, 3);
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < 300; ++y) std::fill_n(grey.plane(p).row(y), 400, 0.4F);
  }
  const auto none = find_chart(grey);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("--corners"));
  EXPECT_FALSE(find_chart(Image<float>({400, 300}, 3))) << "black";
}

TEST(Chart, CountsPixelsThatAreFullAndTellsUnevenPatches) {
  Drawn drawn;
  drawn.angle = 0;
  drawn.draw();
  const auto [x, y] = drawn.corners[0];  // patch 1
  for (int j = 0; j < 60; ++j) {
    for (int i = 0; i < 35; ++i) {
      for (int p = 0; p < 3; ++p) drawn.rgb(static_cast<int>(x) + i, static_cast<int>(y) + j, p) *= 0.5F;
    }
    drawn.rgb(static_cast<int>(x) + 80 + 35, static_cast<int>(y) + j, 1) =
        std::numeric_limits<float>::infinity();
  }
  const auto patches = read_patches(drawn.rgb, drawn.corners);
  ASSERT_TRUE(patches);
  EXPECT_GT((*patches)[0].unevenness, 0.5);
  EXPECT_GT((*patches)[1].full_share, 0.01);
  EXPECT_LT((*patches)[1].full_share, 0.06);
  EXPECT_NEAR((*patches)[1].mean[1], 0.8 * published_chart()[1][1], 1e-6) << "what is full is left out";
}

TEST(Chart, RefusesCornersThatMakeNone) {
  Drawn drawn;
  drawn.draw();
  const ChartCorners outside = {{{-5, 10}, {300, 10}, {300, 200}, {10, 200}}};
  const ChartCorners crossed = {{{10, 10}, {300, 200}, {300, 10}, {10, 200}}};
  const ChartCorners tiny = {{{10, 10}, {20, 10}, {20, 16}, {10, 16}}};
  const ChartCorners line = {{{10, 10}, {200, 10}, {300, 10}, {400, 10}}};
  const ChartCorners nan = {{{std::nan(""), 10}, {200, 10}, {300, 100}, {40, 90}}};
  for (const ChartCorners& corners : {outside, crossed, tiny, line, nan}) {
    const auto patches = read_patches(drawn.rgb, corners);
    ASSERT_FALSE(patches);
    EXPECT_EQ(patches.error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace weft::calibration
