// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/table_ball.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::simulator {
namespace {

// A camera 500 mm above the table, and the ray to a point at the height of the ball's centre.
constexpr double kCamera_mm = 500, kPixel = 0.001;
BallSettings ball() {
  BallSettings ball;
  ball.centre_mm = {0, 0, 20};
  ball.radius_mm = 20;
  return ball;
}
ViewRay ray_to(double x_mm, double y_mm) {
  return {{0, 0, kCamera_mm}, {x_mm / 480, y_mm / 480, -1}, {kPixel, 0, 0}, {0, -kPixel, 0}};
}

TEST(TableBall, IsMetOnItsSurfaceAndCoversHalfAPixelWhereARayTouchesIt) {
  const auto top = hit(ball(), ray_to(0, 0));
  ASSERT_TRUE(top);
  EXPECT_NEAR(top->point_mm.z, 40, 1e-12);
  EXPECT_NEAR(top->normal.z, 1, 1e-12);
  const auto side = hit(ball(), ray_to(12, -5));
  ASSERT_TRUE(side);
  EXPECT_NEAR(length(side->point_mm - ball().centre_mm), 20, 1e-9);
  const Vec3 along = side->point_mm - Vec3{0, 0, kCamera_mm};
  EXPECT_LT(length(cross(normalized(along), normalized(ray_to(12, -5).direction))), 1e-12);
  // A ray at this tangent of its angle to the axis touches the ball.
  const double tangent = 20 / std::sqrt(480.0 * 480 - 400);
  EXPECT_NEAR(hit(ball(), ray_to(480 * tangent, 0))->coverage, 0.5, 1e-6);
  EXPECT_FALSE(hit(ball(), ray_to(480 * (tangent + 2 * kPixel), 0)));
}

TEST(TableBall, MirrorsALampByTheLawOfReflection) {
  const ViewRay ray = ray_to(10, 0);
  const Vec3 normal = hit(ball(), ray)->normal, view = normalized(ray.direction);
  const Vec3 sent = view - 2 * dot(view, normal) * normal;
  const Vec3 beside = normalized(sent + Vec3{0, std::tan(radians(2)), 0});
  ViewRay point = ray;
  point.per_x = point.per_y = {};
  const double width = radians(1.0), most = 0.6 / (2 * width * width);
  EXPECT_NEAR(mirrored(ball(), point, sent), most, 1e-6 * most);
  EXPECT_NEAR(mirrored(ball(), point, beside), most * std::exp(-2.0), 1e-3 * most) << "two widths beside";
  BallSettings matt = ball();
  matt.surface = BallSurface::kMatt;
  EXPECT_EQ(mirrored(matt, point, sent), 0);
}

}  // namespace
}  // namespace weft::simulator
