// SPDX-License-Identifier: Apache-2.0
#include "material/maps/occlusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "bench/oracles/sky_oracle.h"
#include "core/base/vec.h"
#include "simulator/geometry/scene_surface.h"
#include "tests/material/maps/slopes.h"

namespace weft::material {
namespace {

using Heights = std::function<double(double x, double y)>;

Image<float> heights_of(Size size, const Heights& height) {
  Image<float> map(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) map(x, y) = static_cast<float>(height(x, y));
  }
  return map;
}

Occlusion occlusion_of(const Image<float>& height_px, OcclusionOptions options = {}) {
  options.mm_per_pixel = 1;
  Result<Occlusion> found = occlusion(height_px.plane(), options);
  if (!found) {
    ADD_FAILURE() << found.error().message();
    return {Image<float>(height_px.size()), Image<float>(height_px.size(), 3)};
  }
  return std::move(found).value();
}

Vec3 bent_at(const Occlusion& found, int x, int y) {
  return {double{found.bent_normal(x, y, 0)}, double{found.bent_normal(x, y, 1)},
          double{found.bent_normal(x, y, 2)}};
}

TEST(Occlusion, OfASheetIsExactlyOneHoweverItIsTilted) {
  for (const double tilt_deg : {0.0, 5.0, 30.0, 60.0, 85.0, 89.0}) {
    for (const double azimuth_deg : {0.0, 37.0, 90.0, 200.0}) {
      const double c = std::cos(radians(azimuth_deg)), s = std::sin(radians(azimuth_deg));
      const double slope = std::tan(radians(tilt_deg));
      const Occlusion found =
          occlusion_of(heights_of({90, 70}, [&](double x, double y) { return slope * (x * c - y * s); }));
      const Vec3 normal = normalized({-slope * c, -slope * s, 1});
      for (int y = 0; y < 70; ++y) {
        for (int x = 0; x < 90; ++x) {
          ASSERT_EQ(found.openness(x, y), 1.0f) << tilt_deg << " towards " << azimuth_deg;
          ASSERT_LT(angle_deg(bent_at(found, x, y), normal), 0.05) << tilt_deg << " towards " << azimuth_deg;
        }
      }
    }
  }
  const Occlusion high = occlusion_of(heights_of({40, 40}, [](double, double) { return 1e6; }));
  EXPECT_EQ(high.openness(20, 20), 1.0f);
}

// The rim lies between pixels, which is half a pixel of the radius: a wide pit.
TEST(Occlusion, OfAHemisphericalPitIsOneHalfEverywhere) {
  constexpr int kRadius = 250, kMiddle = 260;
  const Occlusion found = occlusion_of(heights_of({2 * kMiddle + 1, 2 * kMiddle + 1}, [](double x, double y) {
    const double r = std::hypot(x - kMiddle, y - kMiddle);
    return r < kRadius ? -std::sqrt(kRadius * kRadius - r * r) : 0.0;
  }));
  for (int y = 0; y <= 2 * kMiddle; ++y) {
    for (int x = 0; x <= 2 * kMiddle; ++x) {
      if (std::hypot(x - kMiddle, y - kMiddle) > 0.8 * kRadius) continue;
      ASSERT_NEAR(found.openness(x, y), 0.5, 0.003) << x << ", " << y;
    }
  }
  EXPECT_LT(angle_deg(bent_at(found, kMiddle, kMiddle), {0, 0, 1}), 0.1);
}

// Two endless walls of elevation t hide 1 - cos t of the sky from the level bottom between them.
TEST(Occlusion, OfTheFloorOfAnEndlessGrooveIsTheCosineOfItsFlank) {
  for (const double flank_deg : {10.0, 20.0, 45.0, 60.0}) {
    const double slope = std::tan(radians(flank_deg));
    const Occlusion found =
        occlusion_of(heights_of({201, 801}, [&](double x, double) { return slope * std::abs(x - 100); }));
    EXPECT_NEAR(found.openness(100, 400), std::cos(radians(flank_deg)), 0.003) << flank_deg;
  }
}

TEST(Occlusion, BendsNormalsAwayFromAWall) {
  const Image<float> step = heights_of({160, 400}, [](double x, double) { return x < 60 ? 12.0 : 0.0; });
  const Occlusion found = occlusion_of(step, {.directions = 16});
  for (const int x : {66, 80, 110}) {
    const double elevation = std::atan(12.0 / (x - 59));
    EXPECT_NEAR(found.openness(x, 200), (1 + std::cos(elevation)) / 2, 0.006) << x;
    // The integral of the cosine-weighted direction over what the wall leaves, in closed form.
    EXPECT_GT(bent_at(found, x, 200).x, 0) << x;
    EXPECT_NEAR(bent_at(found, x, 200).y, 0, 0.01) << x;
  }
  EXPECT_GT(bent_at(found, 66, 200).x, bent_at(found, 110, 200).x);
}

struct RayErrors {
  double rms = 0, bias = 0, bent_deg = 0;
};

simulator::GeometrySettings woven(simulator::Family family) {
  simulator::GeometrySettings geometry = simulator::family_settings(family);
  geometry.warp_pitch_mm = geometry.weft_pitch_mm = 0.83;
  return geometry;
}

// Openness against cosine-weighted rays of the solver's Embree scene, about the normals of the heights
// themselves; bent normals against marching.
RayErrors errors_to_rays(simulator::Family family) {
  constexpr double kScan_mm = 0.04;
  constexpr Rect kTile = {136, 136, 184, 184};
  const simulator::Surface surface = simulator::surface_of(woven(family));
  const Image<float> height = heights_of({320, 320}, [&](double x, double y) {
    return simulator::point_at(surface, kScan_mm * x, -kScan_mm * y).height_mm;
  });
  const auto truth = test::openness_by_rays(height, kScan_mm, kTile);
  const auto found = occlusion(height.plane(), {.mm_per_pixel = kScan_mm});
  EXPECT_TRUE(truth && found);
  RayErrors errors;
  const double count = static_cast<double>(kTile.pixels());
  for (int y = kTile.y0; y < kTile.y1; ++y) {
    for (int x = kTile.x0; x < kTile.x1; ++x) {
      const double e = double{found->openness(x, y)} - double{(*truth)(x - kTile.x0, y - kTile.y0)};
      errors.rms += e * e / count;
      errors.bias += e / count;
    }
  }
  errors.rms = std::sqrt(errors.rms);
  constexpr int kEvery = 5;
  double places = 0;
  for (int y = kTile.y0; y < kTile.y1; y += kEvery) {
    for (int x = kTile.x0; x < kTile.x1; x += kEvery) {
      const test::MarchedSky sky = test::sky_by_marching(height, kScan_mm, x, y);
      errors.bent_deg += angle_deg(sky.bent_normal, bent_at(*found, x, y));
      places += 1;
    }
  }
  errors.bent_deg /= places;
  return errors;
}

TEST(Occlusion, AgreesWithRaysOnWeaves) {
  for (const auto family : {simulator::Family::kPlain, simulator::Family::kDeep}) {
    const RayErrors errors = errors_to_rays(family);
    EXPECT_LT(errors.rms, 0.006);
    EXPECT_LT(std::abs(errors.bias), 0.001);
    EXPECT_LT(errors.bent_deg, 0.4);
  }
}

TEST(Occlusion, OfATileIsThatOfTheMiddleOfNine) {
  const Size size = {60, 60};
  // Every crest is as high as the next, so that no horizon lies farther away than a period.
  const auto height = [&](double x, double y) {
    const double u = 2 * kPi * x / size.width, v = 2 * kPi * y / size.height;
    return 3 * std::sin(10 * u) * std::sin(6 * v) + 0.5 * std::cos(20 * u + 6 * v);
  };
  const Image<float> tile = heights_of(size, height);
  const Image<float> nine = heights_of({180, 180}, [&](double x, double y) {
    return double{tile(static_cast<int>(x) % size.width, static_cast<int>(y) % size.height)};
  });
  const Occlusion wrapped = occlusion_of(tile, {.is_tile = true}), tiled = occlusion_of(nine);
  double least = 1;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      ASSERT_NEAR(wrapped.openness(x, y), tiled.openness(x + size.width, y + size.height), 1e-6)
          << x << ", " << y;
      ASSERT_LT(angle_deg(bent_at(wrapped, x, y), bent_at(tiled, x + size.width, y + size.height)), 1e-3);
      least = std::min(least, double{wrapped.openness(x, y)});
    }
  }
  EXPECT_LT(least, 0.8) << "too open to prove anything";
}

TEST(Occlusion, TurnsWithTheMap) {
  const auto height = [](double x, double y) {
    return 5 * std::sin(0.31 * x + 0.2 * y) + 4 * std::cos(0.17 * y);
  };
  const Occlusion upright = occlusion_of(heights_of({50, 70}, height));
  const Occlusion turned =
      occlusion_of(heights_of({70, 50}, [&](double x, double y) { return height(y, x); }));
  for (int y = 0; y < 70; ++y) {
    for (int x = 0; x < 50; ++x) {
      ASSERT_NEAR(upright.openness(x, y), turned.openness(y, x), 2e-6);
      const Vec3 a = bent_at(upright, x, y), b = bent_at(turned, y, x);
      ASSERT_LT(angle_deg(a, {-b.y, -b.x, b.z}), 1e-3);
    }
  }
}

TEST(Occlusion, TakesAHeightThatIsNotFiniteAsNotThere) {
  Image<float> height =
      heights_of({60, 50}, [](double x, double y) { return 3 * std::sin(0.5 * x) * std::sin(0.4 * y); });
  const Occlusion whole = occlusion_of(height);
  height(30, 25) = std::numeric_limits<float>::quiet_NaN();
  height(0, 0) = std::numeric_limits<float>::infinity();
  height(59, 0) = -std::numeric_limits<float>::infinity();
  const Occlusion found = occlusion_of(height);
  EXPECT_EQ(found.openness(30, 25), 1.0f);
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 60; ++x) {
      ASSERT_TRUE(found.openness(x, y) > 0 && found.openness(x, y) <= 1) << x << ", " << y;
      ASSERT_NEAR(length(bent_at(found, x, y)), 1, 1e-5);
    }
  }
  EXPECT_NEAR(found.openness(10, 40), whole.openness(10, 40), 0.01);
}

TEST(Occlusion, IsFiniteAndAboveZeroInAPitOfOnePixel) {
  for (const double depth : {10.0, 1e4, 1e8}) {
    Image<float> height({31, 31});
    height(15, 15) = static_cast<float>(-depth);
    const Occlusion found = occlusion_of(height);
    EXPECT_GT(found.openness(15, 15), 0);
    EXPECT_LT(found.openness(15, 15), 0.1);
    EXPECT_NEAR(length(bent_at(found, 15, 15)), 1, 1e-5);
  }
}

TEST(Occlusion, HasTheSameBytesOnAnyNumberOfThreadsAndOfAnyShape) {
  for (const Size size : {Size{1, 1}, {1, 40}, {40, 1}, {2, 3}, {130, 90}}) {
    const Image<float> height =
        heights_of(size, [](double x, double y) { return 4 * std::sin(0.7 * x + 0.3 * y * y); });
    const Occlusion one = occlusion_of(height, {.threads = 1}), many = occlusion_of(height, {.threads = 7});
    EXPECT_TRUE(same_floats(one.openness, many.openness));
    EXPECT_TRUE(same_floats(one.bent_normal, many.bent_normal));
  }
}

TEST(Occlusion, RefusesWhatCannotBeMeant) {
  const Image<float> height({8, 8});
  EXPECT_FALSE(occlusion({}, {.mm_per_pixel = 1}));
  EXPECT_FALSE(occlusion(height.plane(), {}));
  EXPECT_FALSE(occlusion(height.plane(), {.mm_per_pixel = 1, .directions = 0}));
  EXPECT_FALSE(occlusion(height.plane(), {.mm_per_pixel = 1, .directions = 65}));
}

}  // namespace
}  // namespace weft::material
