// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/representative_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/simulator/reflectance/measured.h"

namespace weft::simulator {
namespace {

constexpr Rgb kGloss = {0.05, 0.05, 0.05};
constexpr double kDistance_mm = 600;

double point(double alpha, Vec3 l, Vec3 v) {
  return evaluate(Ggx{alpha, kGloss, Beneath::kLambert}, kBlack, l, v)[1] * l.z;
}

/// The mean of f (n.l) over the ball, by stratified Monte Carlo over its solid angle, relative to the
/// irradiance that a point of the same strength gives: pi sin^2 of the half-angle.
double reference(double alpha, Vec3 centre, double radius_mm, Vec3 v, Uniform& uniform_number) {
  const double sine = radius_mm / kDistance_mm, cosine = std::sqrt(1 - sine * sine);
  const Vec3 side = normalized(cross(std::abs(centre.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, centre));
  const Vec3 other = cross(centre, side);
  constexpr int kCells = 40;
  const double mean = mean_over_square(kCells, [&](double u1, double u2) {
    u1 += (uniform_number() - 0.5) / kCells;
    u2 += (uniform_number() - 0.5) / kCells;
    const Vec3 d = from_cosine(1 - u1 * (1 - cosine), u2);
    const Vec3 l = d.x * side + d.y * other + d.z * centre;
    return l.z > 0 ? point(alpha, l, v) : 0;
  });
  return mean * 2 * (1 - cosine) / (sine * sine);
}

/// Largest differences from the reference in percent of the highlight's largest value, light anywhere to 60
/// degrees of zenith, seen from 45 degrees.
struct Errors {
  double as_point = 0, by_representative_point = 0, widened = 0;
};

Errors errors(double alpha, double radius_mm) {
  const Vec3 v = at_angles(45, 180);
  Uniform uniform_number(11);
  double highlight = 0;
  Errors e;
  for (const double zenith_deg : {45.0, 0.0, 10.0, 20.0, 30.0, 40.0, 43.0, 50.0, 60.0}) {
    for (const double azimuth_deg : {0.0, 5.0, 20.0, 90.0}) {
      const Vec3 l = at_angles(zenith_deg, azimuth_deg);
      const double truth = reference(alpha, l, radius_mm, v, uniform_number);
      const double wide = widened_alpha(alpha, radius_mm, kDistance_mm);
      const SphericalLight light = {kDistance_mm * l, radius_mm};
      highlight = std::max(highlight, truth);
      e.as_point = std::max(e.as_point, std::abs(point(alpha, l, v) - truth));
      e.widened = std::max(e.widened, std::abs(point(wide, l, v) - truth));
      e.by_representative_point = std::max(
          e.by_representative_point, std::abs(representative_point(light, v, alpha, kGloss)[1] - truth));
    }
  }
  const double percent = 100 / highlight;
  return {percent * e.as_point, percent * e.by_representative_point, percent * e.widened};
}

TEST(RepresentativePoint, IsThisFarFromMonteCarloAndSoAreAPointAndAWidenedLobe) {
  struct Row {
    double alpha, radius_mm;
    Errors percent;
  };
  for (const Row& row :
       {Row{0.05, 3, {0.4, 6.0, 0.1}}, Row{0.05, 12, {6.0, 17.5, 1.9}}, Row{0.05, 30, {36.7, 23.9, 9.4}},
        Row{0.1, 3, {0.1, 3.2, 0.0}}, Row{0.1, 12, {1.5, 10.8, 0.5}}, Row{0.1, 30, {9.1, 19.8, 2.7}},
        Row{0.2, 12, {0.3, 6.0, 0.1}}, Row{0.2, 60, {8.6, 20.2, 2.1}}, Row{0.5, 12, {0.0, 2.6, 0.0}},
        Row{0.5, 60, {0.8, 11.4, 0.5}}}) {
    const Errors e = errors(row.alpha, row.radius_mm);
    const auto near = [&](double measured, double stated, const char* way) {
      EXPECT_NEAR(measured, stated, 0.15)
          << way << ", alpha " << row.alpha << ", radius " << row.radius_mm << " mm";
    };
    near(e.as_point, row.percent.as_point, "point");
    near(e.by_representative_point, row.percent.by_representative_point, "representative point");
    near(e.widened, row.percent.widened, "widened");
  }
}

TEST(RepresentativePoint, OfALightWithoutRadiusIsThePointItself) {
  const Vec3 v = at_angles(45, 180);
  for (const Vec3 l : {at_angles(45), at_angles(20, 70), at_angles(80, 180)}) {
    EXPECT_NEAR(representative_point({kDistance_mm * l, 0}, v, 0.3, kGloss)[1] / point(0.3, l, v), 1, 1e-12);
    EXPECT_EQ(widened_alpha(0.3, 0, kDistance_mm), 0.3);
  }
}

TEST(RepresentativePoint, LiesTowardsTheMirroredView) {
  // Half-way off the ray by its radius: the printed sign would move the point away from the highlight.
  const Vec3 v = at_angles(45, 180), l = at_angles(35);
  EXPECT_GT(representative_point({kDistance_mm * l, 60}, v, 0.1, kGloss)[1], point(0.1, l, v));
}

TEST(RepresentativePoint, MirrorsNineQuartersOfASharpLightAndAWidenedLobeAllOfIt) {
  const Vec3 up = {0, 0, 1};
  const double sine = 0.05, mirrored_ball = 0.05 / (kPi * sine * sine);  // f0 over the ball's solid angle
  const double radius_mm = sine * kDistance_mm;
  EXPECT_NEAR(representative_point({kDistance_mm * up, radius_mm}, up, 0, kGloss)[1] / mirrored_ball, 2.25,
              0.3);
  EXPECT_NEAR(point(widened_alpha(0, radius_mm, kDistance_mm), up, up) / mirrored_ball, 1, 0.01);
}

TEST(RepresentativePoint, IsFiniteForEveryLight) {
  const Vec3 up = {0, 0, 1};
  const auto green = [&](Vec3 centre_mm, double radius_mm, Vec3 v, double alpha) {
    return representative_point({centre_mm, radius_mm}, v, alpha, kGloss)[1];
  };
  EXPECT_EQ(green({0, 0, 5}, 5, up, 0.3), 0) << "the ball reaches the surface";
  EXPECT_EQ(green({0, 0, 0}, 0, up, 0.3), 0);
  EXPECT_EQ(green({10, 0, 0}, 1, up, 0.3), 0) << "centre on the horizon";
  EXPECT_EQ(green({0, 0, -10}, 1, up, 0.3), 0);
  for (const Vec3 v : {up, at_angles(90), at_angles(120, 40), at_angles(180)}) {
    for (const double alpha : {0.0, 1.0}) {
      for (const Vec3 centre_mm : {Vec3{0, 0, 10}, Vec3{10, 0, 0.01}, Vec3{-7, 7, 1}}) {
        const double f = green(centre_mm, 3, v, alpha);
        EXPECT_TRUE(std::isfinite(f) && f >= 0) << f;
      }
    }
  }
}

}  // namespace
}  // namespace weft::simulator
