// SPDX-License-Identifier: Apache-2.0
// Truth: marks that were drawn at known places, with noise of known size.
#include "calibration/camera/fixed_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "bench/oracles/oracle_rig.h"

namespace weft::calibration {
namespace {

const CameraModel kCamera = overhead_camera({1000, 640}, 600, 0.2);
constexpr double kNoise = 12;

struct Mark {
  double x = 0, y = 0;  ///< cells
  double height = 400;
};

/// Marks in a frame around a sheet: each of a few spots of its own arrangement.
std::vector<Mark> marks_around(std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Mark> marks;
  for (const double y : {25.0, 295.0}) {
    for (double x = 40; x < 480; x += 70) {
      for (int spot = 0; spot < 3; ++spot)
        marks.push_back({x + 3 * random.normal(), y + 3 * random.normal(), 300 + 60 * random.normal()});
    }
  }
  return marks;
}

/// A table in light that falls off, its marks shifted by (dx, dy) cells.
Image<float> table(const std::vector<Mark>& marks, double dx, double dy, test::Random& random) {
  Image<float> cells({500, 320});
  for (int y = 0; y < cells.height(); ++y) {
    for (int x = 0; x < cells.width(); ++x)
      cells(x, y) = static_cast<float>(900 + 0.4 * x - 0.3 * y + kNoise * random.normal());
  }
  for (const Mark& mark : marks) {
    const int cx = static_cast<int>(mark.x + dx), cy = static_cast<int>(mark.y + dy);
    for (int y = std::max(cy - 8, 0); y < std::min(cy + 9, cells.height()); ++y) {
      for (int x = std::max(cx - 8, 0); x < std::min(cx + 9, cells.width()); ++x) {
        const double u = x - mark.x - dx, v = y - mark.y - dy;
        cells(x, y) -= static_cast<float>(mark.height * std::exp(-(u * u + v * v) / (2 * 1.5 * 1.5)));
      }
    }
  }
  return cells;
}

/// A white sheet in the middle, a little elsewhere in each picture, over what is there.
std::vector<PixelPoint> lay_sheet(Image<float>& cells, int picture) {
  const int left = 70 + 5 * picture, right = left + 340, top = 50, bottom = 270;
  for (int y = top; y < bottom; ++y) std::fill_n(cells.plane().row(y) + left, right - left, 4000.0F);
  const auto px = [](int cell) { return 2.0 * cell; };
  return {{px(left), px(top)}, {px(right), px(top)}, {px(right), px(bottom)}, {px(left), px(bottom)}};
}

/// Five pictures with the sheet; `change` draws what else is there.
std::vector<FixedPoint> found_in(
    const std::vector<Mark>& marks, std::uint64_t seed,
    const std::function<void(Image<float>&, int)>& change = [](Image<float>&, int) {},
    std::vector<FixedPoint> known = {}) {
  test::Random random(seed);
  FixedPointFinder finder(kCamera, std::move(known));
  for (int picture = 0; picture < 5; ++picture) {
    Image<float> cells = table(marks, 0, 0, random);
    change(cells, picture);
    const std::vector<PixelPoint> sheet = lay_sheet(cells, picture);
    finder.add(cells, sheet);
  }
  return finder.found();
}

/// The point in a whole picture, as a scan shows it.
std::optional<PointSighting> seen_in(const Image<float>& cells, const FixedPoint& point) {
  const Rect box = search_box(point, point_reach_cells(kCamera, 2), kCamera.size);
  Image<float> part(cells_in(box, 2));
  for (int y = 0; y < part.height(); ++y)
    std::copy_n(cells.plane().row(box.y0 / 2 + y) + box.x0 / 2, part.width(), part.plane().row(y));
  return find_point(point, part, box);
}

TEST(FixedPoints, AreFoundBesideTheSheetAndAgainAfterAKnockAsWellAsTheySay) {
  const std::vector<Mark> marks = marks_around(1);
  const std::vector<FixedPoint> points = found_in(marks, 2);
  ASSERT_GE(points.size(), 10U);
  ASSERT_LE(points.size(), 24U);
  test::Random random(3);
  double squares = 0, worst = 0;
  int seen = 0;
  for (int draw = 0; draw < 40; ++draw) {
    const double dx = 8 * random.normal(), dy = 5 * random.normal();
    if (std::max(std::abs(dx), std::abs(dy)) > 15) continue;
    const Image<float> cells = table(marks, dx, dy, random);
    for (const FixedPoint& point : points) {
      const std::optional<PointSighting> sighting = seen_in(cells, point);
      if (!sighting) continue;
      ++seen;
      const double sigma = std::hypot(sighting->sigma_px, point.sigma_px);
      for (const double off : {sighting->x_px - point.x_px - 2 * dx, sighting->y_px - point.y_px - 2 * dy}) {
        squares += off * off / sigma / sigma / 2;
        worst = std::max(worst, std::abs(off) / sigma);
      }
    }
  }
  ASSERT_GT(seen, 200);
  const double off = std::sqrt(squares / seen);
  EXPECT_GT(off, 0.4) << "standard deviations, rms of " << seen;
  EXPECT_LT(off, 1.1) << "standard deviations, rms of " << seen;
  EXPECT_LT(worst, 6);
}

TEST(FixedPoints, AreNoneOfWhatMovesNorOfWhatIsThereTwiceNorOfAnEmptyTable) {
  EXPECT_EQ(found_in({}, 4).size(), 0U) << "noise";
  std::vector<Mark> holes;
  for (double y = 10; y < 320; y += 12) {
    for (double x = 10; x < 500; x += 12) holes.push_back({x, y});
  }
  EXPECT_EQ(found_in(holes, 5).size(), 0U) << "holes of a breadboard";
  const std::vector<Mark> marks = marks_around(6);
  const auto wander = [](Image<float>& cells, int picture) {
    for (int y = 10; y < 16; ++y) std::fill_n(cells.plane().row(y) + 460 + 4 * picture, 6, 100.0F);
  };
  const auto still = found_in(marks, 7);
  for (const FixedPoint& point : found_in(marks, 7, wander)) {
    EXPECT_FALSE(point.x_px > 2 * 450 && point.y_px < 2 * 26) << point.x_px << ", " << point.y_px;
  }
  EXPECT_GE(still.size(), 10U);
}

TEST(FixedPoints, ThatAClothCoversAreNotSeen) {
  const std::vector<Mark> marks = marks_around(8);
  const std::vector<FixedPoint> points = found_in(marks, 9);
  test::Random random(10);
  // Coarse threads, of more contrast than any mark.
  Image<float> cells({500, 320});
  for (int y = 0; y < cells.height(); ++y) {
    for (int x = 0; x < cells.width(); ++x)
      cells(x, y) =
          static_cast<float>(900 + 300 * std::sin(0.9 * x + 0.2 * std::sin(0.1 * y)) * std::sin(0.8 * y) +
                             150 * random.normal());
  }
  for (const FixedPoint& point : points) {
    const auto seen = seen_in(cells, point);
    EXPECT_FALSE(seen) << seen->x_px << ", " << seen->y_px << " of " << point.x_px << ", " << point.y_px;
  }
}

TEST(FixedPoints, KeepTheirNamesWhenTheyAreMeasuredAgain) {
  const std::vector<Mark> marks = marks_around(11);
  const std::vector<FixedPoint> before = found_in(marks, 12);
  std::vector<Mark> shifted = marks;
  for (Mark& mark : shifted) mark.x += 4.25, mark.y -= 2.5;
  const std::vector<FixedPoint> after = found_in(
      shifted, 13, [](Image<float>&, int) {}, before);
  std::size_t again = 0;
  for (const FixedPoint& point : before) {
    const auto same = std::ranges::find(after, point.id, &FixedPoint::id);
    if (same == after.end()) continue;
    ++again;
    EXPECT_NEAR(same->x_px - point.x_px, 8.5, 0.3);
    EXPECT_NEAR(same->y_px - point.y_px, -5, 0.3);
  }
  EXPECT_GE(again, before.size() / 2) << "of " << before.size();
}

}  // namespace
}  // namespace weft::calibration
