// SPDX-License-Identifier: Apache-2.0
#include "material/table_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "calibration/camera/boards.h"
#include "calibration/camera/markers.h"
#include "core/solve/solve_record.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"

namespace weft::material {
namespace {

/// Half a degree of tilt and a barrel lens.
CameraModel tilted_camera() {
  CameraModel camera = overhead_camera({300, 200}, 600, 0.4);
  camera.k1 = -0.1;
  camera.cx += 3;
  const double s = std::sin(radians(0.5)), c = std::cos(radians(0.5));
  camera.camera_from_rig_rotation = {{{1, 0, 0}, {0, -c, s}, {0, -s, -c}}};
  camera.camera_from_rig_translation_mm = {1, -2, 600};
  return camera;
}

TableGrid grid_of(const CameraModel& camera, const TableGridOptions& options) {
  const Result<TableGrid> grid = table_grid(camera, options);
  EXPECT_TRUE(grid) << grid.error().message();
  return grid ? *grid : TableGrid();
}

/// A map whose planes are functions of the point of the plane z = height that each pixel sees.
using OfPoint = std::vector<std::function<double(Vec3)>>;
Image<float> map_of(const CameraModel& camera, double height_mm, const OfPoint& planes) {
  Image<float> map(camera.size, static_cast<int>(planes.size()));
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const Vec3 point = point_on_plane(camera, x, y, height_mm);
      for (int p = 0; p < map.planes(); ++p)
        map(x, y, p) = static_cast<float>(planes[static_cast<std::size_t>(p)](point));
    }
  }
  return map;
}

Image<float> rectified(const CameraModel& camera, const TableGrid& grid, MapKind kind,
                       const Image<float>& map, const Image<std::uint16_t>& status, int band = 1 << 20,
                       int threads = 1) {
  Image<float> out(grid.size, map.planes());
  std::vector<View<const float>> planes;
  for (int p = 0; p < map.planes(); ++p) planes.push_back(map.plane(p));
  for (int y = 0; y < grid.size.height; y += band) {
    std::vector<View<float>> rows;
    for (int p = 0; p < map.planes(); ++p)
      rows.push_back(out.plane(p).crop({0, y, grid.size.width, std::min(y + band, grid.size.height)}));
    rectify_rows(camera, grid, kind, planes, status.plane(), y, threads, rows);
  }
  return out;
}

TEST(TableGrid, LiesInTheFrameAndNearlyFillsIt) {
  const CameraModel camera = tilted_camera();
  for (const double turn_deg : {0.0, 30.0, -90.0}) {
    const TableGrid grid = grid_of(camera, {.height_mm = 2, .turn_deg = turn_deg});
    EXPECT_NEAR(grid.mm_per_pixel, 0.4 * 598 / 600, 0.005);
    double margin = 1e9;
    for (int x : {0, grid.size.width / 2, grid.size.width - 1}) {
      for (int y : {0, grid.size.height / 2, grid.size.height - 1}) {
        const Vec3 p = project(camera, grid.point_mm(x, y));
        margin = std::min({margin, p.x, p.y, 299 - p.x, 199 - p.y});
      }
    }
    EXPECT_GE(margin, -1e-5) << turn_deg;
    EXPECT_LT(margin, 5) << turn_deg;
    if (turn_deg == 0) {
      EXPECT_GT(grid.size.width, 285);
      EXPECT_GT(grid.size.height, 190);
    }
  }
}

TEST(TableGrid, RefusesSizesThatMakeNoPicture) {
  const CameraModel camera = tilted_camera();
  for (const double mm :
       {-1.0, 1e-4, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Result<TableGrid> grid = table_grid(camera, {.mm_per_pixel = mm});
    ASSERT_FALSE(grid) << mm;
    EXPECT_EQ(grid.error().kind, ErrorKind::kUsage);
  }
  CameraModel away = camera;
  away.camera_from_rig_translation_mm.z = -600;
  EXPECT_FALSE(table_grid(away, {}));
}

TEST(Rectify, PutsEveryPointOfTheTableInItsPlace) {
  // The map holds the place that each pixel sees: on the grid it must be the place of the grid's pixel.
  const CameraModel camera = tilted_camera();
  const Image<std::uint16_t> status(camera.size);
  for (const double turn_deg : {0.0, 12.0}) {
    const TableGrid grid = grid_of(camera, {.mm_per_pixel = 0.35, .height_mm = 3, .turn_deg = turn_deg});
    const Image<float> map = map_of(camera, 3, {[](Vec3 p) { return p.x; }, [](Vec3 p) { return p.y; }});
    const Image<float> out = rectified(camera, grid, MapKind::kValue, map, status);
    double farthest_mm = 0;
    for (int y = 2; y < grid.size.height - 2; ++y) {
      for (int x = 2; x < grid.size.width - 2; ++x) {
        const Vec3 point = grid.point_mm(x, y);
        farthest_mm = std::max(farthest_mm, std::hypot(static_cast<double>(out(x, y, 0)) - point.x,
                                                       static_cast<double>(out(x, y, 1)) - point.y));
      }
    }
    EXPECT_LT(farthest_mm, 1e-3) << turn_deg;
  }
}

TEST(Rectify, LeavesAMapAloneThatIsOnTheGrid) {
  const CameraModel camera = overhead_camera({40, 30}, 600, 0.5);
  const TableGrid grid = grid_of(camera, {.mm_per_pixel = 0.5});
  ASSERT_EQ(grid.size, camera.size);
  Image<float> map(camera.size);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) map(x, y) = static_cast<float>((x * 7 + y * 13) % 11);
  }
  const Image<float> out = rectified(camera, grid, MapKind::kValue, map, Image<std::uint16_t>(camera.size));
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) EXPECT_NEAR(out(x, y), map(x, y), 1e-5) << x << ", " << y;
  }
}

TEST(Rectify, TurnsNormalsWithTheGrid) {
  const CameraModel camera = overhead_camera({60, 60}, 600, 0.5);
  const TableGrid grid = grid_of(camera, {.turn_deg = 90});
  const Vec3 normal = normalized({0.3, 0.1, 1});
  const Image<float> map = map_of(
      camera, 0,
      {[&](Vec3) { return normal.x; }, [&](Vec3) { return normal.y; }, [&](Vec3) { return normal.z; }});
  const Image<float> out = rectified(camera, grid, MapKind::kNormal, map, Image<std::uint16_t>(camera.size));
  // Columns run along the rig's y axis, rows upwards against its x axis.
  EXPECT_NEAR(out(20, 20, 0), normal.y, 1e-6);
  EXPECT_NEAR(out(20, 20, 1), -normal.x, 1e-6);
  EXPECT_NEAR(out(20, 20, 2), normal.z, 1e-6);
  const Vec3 right = grid.point_mm(1, 0) - grid.point_mm(0, 0);
  EXPECT_LT(angle_deg(right, {0, 1, 0}), 1e-9);
}

TEST(Rectify, AveragesWhatIsFinerThanACoarseGrid) {
  // Stripes one pixel wide would alias to any value between 0 and 1.
  const CameraModel camera = overhead_camera({400, 300}, 600, 0.5);
  const TableGrid grid = grid_of(camera, {.mm_per_pixel = 2.3});
  Image<float> map(camera.size);
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) map(x, y) = static_cast<float>(x % 2);
  }
  const Image<float> out = rectified(camera, grid, MapKind::kValue, map, Image<std::uint16_t>(camera.size));
  for (int x = 3; x < grid.size.width - 3; ++x) EXPECT_NEAR(out(x, 10), 0.5, 0.02) << x;
}

TEST(Rectify, LeavesOutWhatHasNoSolutionAndGivesNoNan) {
  const CameraModel camera = tilted_camera();
  const TableGrid grid = grid_of(camera, {});
  Image<std::uint16_t> status(camera.size);
  Image<float> map =
      map_of(camera, 0, {[](Vec3) { return 0.25; }, [](Vec3) { return 0.5; }, [](Vec3) { return 0.75; }});
  for (int y = 60; y < 90; ++y) {
    for (int x = 100; x < 140; ++x) {
      status(x, y) = kNoSolution | kDark;
      for (int p = 0; p < 3; ++p) map(x, y, p) = 1e6F;
    }
  }
  map(200, 100, 1) = std::numeric_limits<float>::quiet_NaN();
  status(30, 30) = kShadowed;
  const Image<float> values = rectified(camera, grid, MapKind::kValue, map, status);
  const Image<float> normals = rectified(camera, grid, MapKind::kNormal, map, status);
  const Image<float> sigmas = rectified(camera, grid, MapKind::kSigma, map, status);
  Image<std::uint16_t> bits(grid.size);
  rectify_status_rows(camera, grid, status.plane(), 0, 1, bits.plane());
  int unsolved = 0, shadowed = 0;
  for (int y = 0; y < grid.size.height; ++y) {
    for (int x = 0; x < grid.size.width; ++x) {
      ASSERT_TRUE(std::isfinite(values(x, y, 1)));
      const Vec3 at = project(camera, grid.point_mm(x, y));
      if (std::hypot(at.x - 200, at.y - 100) < 4) continue;  // what is not a number is not in the status
      const bool is_unsolved = (bits(x, y) & kNoSolution) != 0;
      unsolved += is_unsolved;
      shadowed += (bits(x, y) & kShadowed) != 0;
      ASSERT_NEAR(values(x, y, 1), is_unsolved ? 0 : 0.5, 1e-4) << x << ", " << y;
      ASSERT_NEAR(sigmas(x, y, 1), is_unsolved ? 180 : 0.5, 1e-4) << x << ", " << y;
      ASSERT_NEAR(std::hypot(normals(x, y, 0), normals(x, y, 1), normals(x, y, 2)), 1, 1e-5);
      if (is_unsolved) {
        ASSERT_EQ(normals(x, y, 2), 1);
      }
    }
  }
  EXPECT_NEAR(unsolved, 30 * 40, 40);
  EXPECT_EQ(shadowed, 1);
}

TEST(Rectify, GivesTheSameBytesForAnyBandsAndThreads) {
  const CameraModel camera = tilted_camera();
  const TableGrid grid = grid_of(camera, {.turn_deg = 5});
  const Image<std::uint16_t> status(camera.size);
  const Image<float> map = map_of(camera, 0,
                                  {[](Vec3 p) { return std::sin(p.x); }, [](Vec3 p) { return std::cos(p.y); },
                                   [](Vec3 p) { return 2 + std::sin(p.x * p.y); }});
  for (const MapKind kind : {MapKind::kValue, MapKind::kNormal, MapKind::kSigma}) {
    const Image<float> whole = rectified(camera, grid, kind, map, status);
    const Image<float> parts = rectified(camera, grid, kind, map, status, 7, 3);
    for (int p = 0; p < 3; ++p) {
      for (int y = 0; y < grid.size.height; ++y) {
        ASSERT_TRUE(
            std::equal(whole.plane(p).row(y), whole.plane(p).row(y) + grid.size.width, parts.plane(p).row(y)))
            << "plane " << p << ", row " << y;
      }
    }
  }
}

TEST(Rectify, MakesThePitchOfARenderedRulerTrueAnywhere) {
  // A grid of 12 mm under k1 = -0.1 and half a degree of tilt, 3 mm above the table.
  simulator::Scene scene;
  scene.camera.width = 640;
  scene.camera.height = 420;
  scene.camera.mm_per_pixel = 0.3;
  scene.camera.pose = {.tilt_deg = 0.5, .azimuth_deg = 35};
  scene.camera.lens = {.k1 = -0.1};
  scene.camera.blur = {.defocus_px = 0.8, .spread_px = 0.6};
  scene.geometry.cloth_height_mm = 3;
  scene.material.albedo = {0.2, 0.2, 0.2};
  scene.targets.resize(1);
  scene.targets[0].pattern = simulator::CheckerboardSettings{14, 9, 12, 4};
  scene.targets[0].centre_mm = {0, 0, 3};
  scene.effects.near_light = scene.effects.distortion = scene.effects.defocus = true;
  const Result<simulator::Rendering> picture = simulator::render_readings(scene, {0, 0, 640, 420});
  ASSERT_TRUE(picture) << picture.error().message();
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  ASSERT_TRUE(rig);
  Image<float> map(rig->camera.size);
  for (int y = 0; y < 420; ++y) {
    for (int x = 0; x < 640; ++x) map(x, y) = static_cast<float>(picture->readings(x, y, 1));
  }
  const TableGrid grid = grid_of(rig->camera, {.mm_per_pixel = 0.25, .height_mm = 3});
  const Image<float> out =
      rectified(rig->camera, grid, MapKind::kValue, map, Image<std::uint16_t>(map.size()));

  const std::vector<View<const float>> grey_planes(3, out.plane());
  const Image<std::uint8_t> grey = calibration::grey_picture(grey_planes);
  const auto board = calibration::find_board(
      grey.plane(),
      {.kind = calibration::BoardKind::kCheckerboard, .squares_x = 14, .squares_y = 9, .square_mm = 12});
  ASSERT_EQ(board.fault, calibration::BoardFault::kNone) << board.why;
  double farthest_mm = 0, pitch_error_mm = 0;
  for (const auto& corner : board.corners) {
    const Vec3 place = grid.point_mm(corner.px.x, corner.px.y);
    farthest_mm = std::max(farthest_mm, std::hypot(place.x - corner.u_mm, place.y - corner.v_mm));
    for (const auto& other : board.corners) {
      if (std::abs(other.u_mm - corner.u_mm - 12) > 1 || std::abs(other.v_mm - corner.v_mm) > 1) continue;
      const Vec3 next = grid.point_mm(other.px.x, other.px.y);
      pitch_error_mm = std::max(pitch_error_mm, std::abs(length(next - place) - 12));
    }
  }
  EXPECT_LT(pitch_error_mm, 0.05);
  EXPECT_LT(farthest_mm, 0.05);
}

}  // namespace
}  // namespace weft::material
