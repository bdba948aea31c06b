// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/height_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>

#include "simulator/transport/bounces.h"
#include "tests/simulator/transport/surfaces.h"

namespace weft::simulator {
namespace {

RayBatch one_ray(Vec3 start_mm, Vec3 direction, double length_mm = 100) {
  RayBatch rays;
  rays.resize(1);
  aim_along({.rays = 1, .reach_mm = 1e3}, start_mm, direction, length_mm, 0, rays);
  return rays;
}

std::uint32_t met_by(const HeightMesh& mesh, Vec3 start_mm, Vec3 direction, double length_mm = 100) {
  std::uint32_t met = 0;
  mesh.find_nearest_vertices(one_ray(start_mm, direction, length_mm), {&met, 1});
  return met;
}

/// How far along the ray, from `least` on, and where in the triangle it meets it.
struct Meeting {
  double t, u, v;
};
std::optional<Meeting> meet(Vec3 start, Vec3 direction, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 p = cross(direction, c - a), s = start - a, q = cross(s, b - a);
  const double determinant = dot(b - a, p);
  const double u = dot(s, p) / determinant, v = dot(direction, q) / determinant;
  const double t = dot(c - a, q) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0)) return {};
  return Meeting{t, u, v};
}

/// The vertex that a ray meets, by trying every triangle in double. `margin` is how far from undecided it is.
std::uint32_t nearest_by_trial(const HeightMesh& mesh, Vec3 start, Vec3 direction, double reach_mm,
                               double& margin) {
  const auto position = [&](int x, int y) {
    const float* p = &mesh.positions_mm()[3 * mesh.vertex(x, y)];
    return Vec3{p[0], p[1], p[2]};
  };
  std::uint32_t nearest = kLeft;
  double first = reach_mm;
  margin = 1;
  const Rect area = mesh.area();
  for (int y = area.y0; y + 1 < area.y1; ++y) {
    for (int x = area.x0; x + 1 < area.x1; ++x) {
      const Vec3 p00 = position(x, y), p10 = position(x + 1, y), p01 = position(x, y + 1);
      auto m = meet(start, direction, p00, p10, p01);
      auto other = meet(start, direction, position(x + 1, y + 1), p01, p10);
      if (other && (!m || other->t < m->t)) m = Meeting{other->t, 1 - other->u, 1 - other->v};
      if (!m || m->t >= first) continue;
      first = m->t;
      margin = std::min(std::abs(m->u - 0.5), std::abs(m->v - 0.5));
      nearest = static_cast<std::uint32_t>(mesh.vertex(x + (m->u > 0.5 ? 1 : 0), y + (m->v > 0.5 ? 1 : 0)));
    }
  }
  return nearest;
}

TEST(HeightMesh, MeetsTheVertexThatTryingEveryTriangleFinds) {
  const Rect area{-3, 5, 37, 45};
  const TestSurface surface = bumpy_surface(area);
  const HeightMesh mesh = surface.mesh();
  const RaySettings settings{.rays = 8, .reach_mm = 0.5, .seed = 1};
  const Rect pixels{10, 18, 22, 30};
  const RayBatch rays = bounce_rays(mesh, surface.normals, pixels, settings);
  std::vector<std::uint32_t> met(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  mesh.find_nearest_vertices(rays, met);
  mesh.occlude(rays, blocked);
  int compared = 0, hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    double margin = 0;
    const std::uint32_t expected = nearest_by_trial(
        mesh, {rays.origin_x_mm[i], rays.origin_y_mm[i], rays.origin_z_mm[i]},
        {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]}, rays.length_mm[i], margin);
    EXPECT_EQ(blocked[i] != 0, expected != kLeft) << "ray " << i;
    if (margin < 1e-4) continue;
    ++compared;
    hits += expected != kLeft;
    EXPECT_EQ(met[i], expected) << "ray " << i << ", margin " << margin;
  }
  EXPECT_GT(compared, 1100) << "of 1152";
  EXPECT_GT(hits, 200);
}

TEST(HeightMesh, TellsFrontFromBackWhicheverWayItsRowsRun) {
  for (const int down : {-1, 1}) {
    const HeightMesh mesh = surface_over({0, 0, 4, 4}, [&](int x, int y) {
                              return std::pair{Vec3{1.0 * x, 1.0 * down * y, 0}, Vec3{0, 0, 1}};
                            }).mesh();
    EXPECT_EQ(met_by(mesh, {1.2, down * 2.4, 5}, {0, 0, -1}), mesh.vertex(1, 2));
    EXPECT_EQ(met_by(mesh, {1.7, down * 2.6, 5}, {0, 0, -1}), mesh.vertex(2, 3));
    EXPECT_EQ(met_by(mesh, {1.2, down * 2.4, -5}, {0, 0, 1}), kDark);
    EXPECT_EQ(met_by(mesh, {1.2, down * 2.4, 5}, {0, 0, 1}), kLeft);
    EXPECT_EQ(met_by(mesh, {1.2, down * 2.4, 5}, {0, 0, -1}, 4.9), kLeft) << "out of reach";
    EXPECT_EQ(met_by(mesh, {7, 7, 5}, {0, 0, -1}), kLeft) << "beside the cloth";
  }
}

TEST(HeightMesh, TakesUnder40BytesAPoint) {
  const TestSurface surface = bumpy_surface({0, 0, 200, 200});
  const std::int64_t before = HeightMesh::bytes_in_use();
  {
    const HeightMesh mesh = surface.mesh();
    const auto bytes = static_cast<double>(HeightMesh::bytes_in_use() - before);
    EXPECT_LT(bytes / (200 * 200), 40);
    EXPECT_GT(bytes / (200 * 200), 12) << "three floats at least";
  }
  EXPECT_EQ(HeightMesh::bytes_in_use(), before);
}

TEST(HeightMesh, StartsRaysASixtyFourthOfAStepAboveTheCloth) {
  const HeightMesh mesh = surface_over({5, 5, 9, 9}, [](int x, int y) {
                            return std::pair{Vec3{2.0 * x, 0.5 * y, 3}, Vec3{0, 0, 1}};
                          }).mesh();
  EXPECT_EQ(mesh.ray_start_mm(6, 7), (Vec3{12, 3.5, 3 + 2.0 / 64}));
  EXPECT_EQ(mesh.ray_start_mm(8, 8), (Vec3{16, 4, 3 + 2.0 / 64}));
}

TEST(HeightMesh, OfOneRowOrColumnHasNoSurface) {
  for (const Rect area : {Rect{0, 0, 1, 1}, Rect{0, 0, 1, 9}, Rect{0, 0, 9, 1}, Rect{-4, -4, -2, -2}}) {
    const TestSurface surface = surface_over(area, [](int x, int y) {
      return std::pair{Vec3{1.0 * x, 1.0 * y, 0}, Vec3{0, 0, 1}};
    });
    const HeightMesh mesh = surface.mesh();
    const auto bounces = Bounces::trace(mesh, surface.normals, area, {.rays = 20, .reach_mm = 3});
    ASSERT_TRUE(bounces) << bounces.error().message();
    const Image<float> openness = bounces->openness();
    for (int y = 0; y < area.height(); ++y) {
      for (int x = 0; x < area.width(); ++x) EXPECT_EQ(openness(x, y), 1);
    }
  }
}

TEST(HeightMesh, RefusesWhatIsNoSurface) {
  const auto why = [](Rect area, std::vector<Vec3> points_mm) {
    const auto mesh = HeightMesh::build(area, points_mm);
    if (mesh) return std::string("accepted");
    EXPECT_EQ(mesh.error().kind, ErrorKind::kBadData);
    return mesh.error().why;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<Vec3> points_mm(6);
  EXPECT_EQ(why({0, 0, 3, 2}, points_mm), "accepted");
  EXPECT_EQ(why({0, 0, 2, 2}, points_mm), "6 points for 4 pixels");
  EXPECT_EQ(why({0, 0, 0, 2}, {}), "0 x 2 points");
  EXPECT_EQ(why({0, 0, 40000, 1}, std::vector<Vec3>(40000)), "40000 x 1 points");
  points_mm[4].z = kNan;
  EXPECT_EQ(why({10, 20, 13, 22}, points_mm), "the point of pixel (11, 21) is (0, 0, nan) mm");
  points_mm[4] = {-kInfinity, 0, 0};
  EXPECT_EQ(why({10, 20, 13, 22}, points_mm), "the point of pixel (11, 21) is (-inf, 0, 0) mm");
  points_mm[4] = {0, 1e30, 0};
  EXPECT_EQ(why({10, 20, 13, 22}, points_mm), "the point of pixel (11, 21) is (0, 1e+30, 0) mm");
}

TEST(HaloFor, HoldsTheReachAndACell) {
  EXPECT_EQ(halo_for(1.6, 0.05), 33);
  EXPECT_EQ(halo_for(0.01, 0.05), 2);
}

}  // namespace
}  // namespace weft::simulator
