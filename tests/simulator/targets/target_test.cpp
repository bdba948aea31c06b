// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/target.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace weft::simulator {
namespace {

Target target_of(const TargetSettings& settings) {
  auto target = Target::make(settings, 1, 0);
  EXPECT_TRUE(target) << target.error().message();
  return target ? *std::move(target) : *Target::make({}, 1, 0);
}

TargetSettings posed(double tilt_deg, double azimuth_deg, double rotation_deg) {
  TargetSettings settings;
  settings.pattern = PaperSettings{100, 60};
  settings.centre_mm = {12, -7, 31};
  settings.tilt_deg = tilt_deg;
  settings.azimuth_deg = azimuth_deg;
  settings.rotation_deg = rotation_deg;
  return settings;
}

ViewRay ray_to(Vec3 point_mm) {
  const Vec3 origin = {3, 4, 600};
  return {origin, point_mm - origin, {}, {}};
}

TEST(Target, FacesTheWayItsAnglesSay) {
  const double t = radians(20);
  const double a = radians(130);
  const Vec3 normal = target_of(posed(20, 130, 45)).normal();
  EXPECT_LT(angle_deg(normal, {std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)}), 1e-12);
}

TEST(Target, LiesWithItsSidesAlongTheTableUnlessTurned) {
  const Target level = target_of(posed(0, 77, 0));
  EXPECT_LT(length(level.place_mm(10, 5) - Vec3{22, -2, 31}), 1e-12);
  const Target turned = target_of(posed(0, 77, 90));
  EXPECT_LT(length(turned.place_mm(10, 5) - Vec3{7, 3, 31}), 1e-12);
}

TEST(Target, IsHitByARayWhereThePlaneIs) {
  for (const double tilt : {0.0, 25.0, 60.0}) {
    const Target target = target_of(posed(tilt, -140, 33));
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {49.0, 29.0}, {-49.0, 12.0}, {20.0, -29.0}}) {
      const Vec3 place = target.place_mm(u, v);
      const auto hit = target.hit(ray_to(place));
      ASSERT_TRUE(hit) << tilt << ": " << u << ", " << v;
      EXPECT_NEAR(hit->spot.u_mm, u, 1e-10);
      EXPECT_NEAR(hit->spot.v_mm, v, 1e-10);
      EXPECT_NEAR(hit->distance_mm, length(place - Vec3{3, 4, 600}), 1e-10);
      EXPECT_LT(length(target.at(hit->spot).point_mm - place), 1e-10);
    }
  }
}

TEST(Target, IsNotHitBesideItsEdgesFromBehindNorBackwards) {
  const Target target = target_of(posed(25, 10, 5));
  EXPECT_FALSE(target.hit(ray_to(target.place_mm(50.01, 0))));
  EXPECT_FALSE(target.hit(ray_to(target.place_mm(0, -30.01))));
  ViewRay away = ray_to(target.place_mm(0, 0));
  away.direction = -1.0 * away.direction;
  EXPECT_FALSE(target.hit(away));
  EXPECT_FALSE(target.hit({{0, 0, -600}, {0, 0, 1}, {}, {}}));
  EXPECT_FALSE(target.hit({{0, 0, 600}, {0, 0, 0}, {}, {}}));
  EXPECT_FALSE(target.hit({{0, 0, 600}, {0, 0, std::numeric_limits<double>::quiet_NaN()}, {}, {}}));
}

TEST(Target, SeesAPixelAsWideAsItsProjection) {
  TargetSettings settings = posed(40, 0, 0);  // leans along u
  settings.centre_mm = {0, 0, 0};
  const Target target = target_of(settings);
  const double per_pixel = 1.0 / 1500;
  const ViewRay ray = {{0, 0, 600}, {0, 0, -1}, {per_pixel, 0, 0}, {0, -per_pixel, 0}};
  const auto hit = target.hit(ray);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->spot.width_mm, 0.4 / std::cos(radians(40)), 1e-12);
  EXPECT_NEAR(hit->spot.height_mm, 0.4, 1e-12);

  settings.rotation_deg = 45;
  settings.tilt_deg = 0;
  const auto turned = target_of(settings).hit(ray);
  ASSERT_TRUE(turned);
  EXPECT_NEAR(turned->spot.width_mm, 0.4, 1e-12) << "the variance of a square is the same in all directions";
}

TEST(Target, PredictsTheStepToTheNextPixel) {
  const Target target = target_of(posed(35, 70, 20));
  const double per_pixel = 1e-6;  // so small that the step is its own derivative
  ViewRay ray = ray_to({5, 2, 25});
  ray.direction = (-1 / ray.direction.z) * ray.direction;
  ray.per_x = {per_pixel, 0, 0};
  ray.per_y = {0, per_pixel, 0};
  const auto here = target.hit(ray);
  ViewRay next = ray;
  next.direction = ray.direction + ray.per_x;
  const auto right = target.hit(next);
  next.direction = ray.direction + ray.per_y;
  const auto below = target.hit(next);
  ASSERT_TRUE(here && right && below);
  const double width = std::hypot(right->spot.u_mm - here->spot.u_mm, below->spot.u_mm - here->spot.u_mm);
  const double height = std::hypot(right->spot.v_mm - here->spot.v_mm, below->spot.v_mm - here->spot.v_mm);
  EXPECT_NEAR(here->spot.width_mm / width, 1, 1e-5);
  EXPECT_NEAR(here->spot.height_mm / height, 1, 1e-5);
}

TEST(Target, IsSeenInPartByAPixelAcrossItsEdge) {
  TargetSettings settings = posed(0, 0, 0);
  settings.centre_mm = {};
  const Target target = target_of(settings);
  ViewRay ray = ray_to({50.1, 0, 0});
  ray.direction = (-1 / ray.direction.z) * ray.direction;
  ray.per_x = {1.0 / 1500, 0, 0};
  ray.per_y = {0, 1.0 / 1500, 0};
  const auto hit = target.hit(ray);
  ASSERT_TRUE(hit) << "a box of 0.4 mm reaches 0.1 mm over the edge";
  EXPECT_NEAR(target.at(hit->spot).coverage, 0.25, 1e-9);
  ray.direction = ray.direction + 0.3 * ray.per_x;
  EXPECT_FALSE(target.hit(ray));
}

TEST(Target, LeansWithItsWaves) {
  TargetSettings settings = posed(30, 0, 0);
  settings.sheet.waviness_deg = 3;
  const Target target = target_of(settings);
  const TargetSpot spot = {17, 9};
  const double h = 1e-4;
  const auto place = [&](double u, double v) { return target.at({u, v}).point_mm; };
  const Vec3 along_u = place(spot.u_mm + h, spot.v_mm) - place(spot.u_mm - h, spot.v_mm);
  const Vec3 along_v = place(spot.u_mm, spot.v_mm + h) - place(spot.u_mm, spot.v_mm - h);
  EXPECT_LT(angle_deg(target.at(spot).normal, cross(along_u, along_v)), 1e-5);
  EXPECT_GT(angle_deg(target.at(spot).normal, target.normal()), 0.1);
}

TEST(Target, HasTheInksOfItsKind) {
  TargetSettings settings;
  settings.pattern = GreyScaleSettings{{0.8, 0.4}, 20, 2, 5};
  const auto scale = inks_of(settings, {});
  ASSERT_TRUE(scale) << scale.error().message();
  EXPECT_EQ(*scale,
            (std::vector{flat_spectrum(0.9), flat_spectrum(0.04), flat_spectrum(0.8), flat_spectrum(0.4)}));

  settings.pattern = ChartSettings{};
  EXPECT_EQ(inks_of(settings, {}).error().where, "chart");
  const std::vector<Spectrum> chart(24, flat_spectrum(0.3));
  EXPECT_EQ(inks_of(settings, chart)->size(), 26U);

  settings.pattern = GreyScaleSettings{{0.8, 1.4}, 20, 2, 5};
  EXPECT_EQ(inks_of(settings, {}).error().where, "reflectances");
  settings = {};
  settings.white = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(inks_of(settings, {}).error().where, "white");
}

TEST(Target, NamesTheSettingThatIsOutOfItsRange) {
  EXPECT_EQ(Target::make(posed(86, 0, 0), 1, 0).error().where, "tilt_deg");
  EXPECT_EQ(Target::make(posed(0, 400, 0), 1, 0).error().where, "azimuth_deg");
  TargetSettings settings;
  settings.centre_mm.y = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Target::make(settings, 1, 0).error().where, "centre_mm");
  settings = {};
  settings.sheet.grain_percent = 21;
  EXPECT_EQ(Target::make(settings, 1, 0).error().where, "grain_percent");
}

}  // namespace
}  // namespace weft::simulator
