// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/demosaic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/oracles/rig.h"
#include "tests/simd_targets.h"

namespace weft {
namespace {

// A mosaic of a colour that changes linearly over the image, in the three channels alike.
double plane_at(int x, int y) {
  return 0.3 + 0.01 * x - 0.004 * y;
}

struct Rgb {
  Image<float> planes;
  explicit Rgb(Size size) : planes(size, 3) {}
  std::array<View<float>, 3> views() { return {planes.plane(0), planes.plane(1), planes.plane(2)}; }
};

TEST(Demosaic, ReproducesALinearGreyExactlyAwayFromTheEdges) {
  const Size size = {37, 23};
  Image<float> mosaic(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mosaic(x, y) = static_cast<float>(plane_at(x, y));
  }
  test::on_every_target([&] {
    Rgb rgb(size);
    solver::demosaic(mosaic.plane(), {}, {0, 0, size.width, size.height}, rgb.views());
    for (int y = 2; y < size.height - 2; ++y) {
      for (int x = 2; x < size.width - 2; ++x) {
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(rgb.planes(x, y, c), plane_at(x, y), 1e-6) << x << ", " << y << " channel " << c;
        }
      }
    }
  });
}

TEST(Demosaic, KeepsAFlatColourForEveryFilterPhase) {
  const Size size = {16, 16};
  const std::array<double, 3> colour = {0.7, 0.4, 0.1};
  for (int phase = 0; phase < 4; ++phase) {
    CfaPattern cfa;
    for (int y = 0; y < 2; ++y) {
      for (int x = 0; x < 2; ++x) {
        cfa.site[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
            CfaPattern().site_at(x + phase % 2, y + phase / 2);
      }
    }
    Image<float> mosaic(size);
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        mosaic(x, y) = static_cast<float>(colour[static_cast<std::size_t>(cfa.channel_at(x, y))]);
      }
    }
    Rgb rgb(size);
    solver::demosaic(mosaic.plane(), cfa, {0, 0, 16, 16}, rgb.views());
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(rgb.planes(x, y, c), colour[static_cast<std::size_t>(c)], 1e-6)
              << "phase " << phase << " at " << x << ", " << y << " channel " << c;
        }
      }
    }
  }
}

TEST(Demosaic, KeepsWhatWasMeasured) {
  const Size size = {33, 9};
  Image<float> mosaic(size);
  test::Random random(5);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mosaic(x, y) = static_cast<float>(random.uniform());
  }
  Rgb rgb(size);
  solver::demosaic(mosaic.plane(), {}, {0, 0, size.width, size.height}, rgb.views());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      ASSERT_EQ(rgb.planes(x, y, CfaPattern().channel_at(x, y)), mosaic(x, y)) << x << ", " << y;
    }
  }
}

TEST(Demosaic, GivesTheSameBytesForAnyPartOfTheImage) {
  const Size size = {200, 40};
  Image<float> mosaic(size);
  test::Random random(6);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mosaic(x, y) = static_cast<float>(random.uniform());
  }
  Rgb whole(size), part({70, 11});
  solver::demosaic(mosaic.plane(), {}, {0, 0, size.width, size.height}, whole.views());
  solver::demosaic(mosaic.plane(), {}, {64, 7, 134, 18}, part.views());
  for (int y = 0; y < 11; ++y) {
    for (int x = 0; x < 70; ++x) {
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(part.planes(x, y, c), whole.planes(x + 64, y + 7, c)) << x << ' ' << y;
    }
  }
}

TEST(Demosaic, StaysInsideImagesOfOneSite) {
  for (const Size size : {Size{1, 1}, Size{1, 5}, Size{5, 1}, Size{2, 2}}) {
    Image<float> mosaic(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) mosaic(x, y) = 0.25f;
    }
    Rgb rgb(size);
    solver::demosaic(mosaic.plane(), {}, {0, 0, size.width, size.height}, rgb.views());
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(rgb.planes(0, 0, c)));
  }
}

TEST(DemosaicSigma, IsTheScatterOfDemosaicedNoise) {
  const Size size = {256, 256};
  Image<float> noise(size), sigma(size);
  test::Random random(8);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      sigma(x, y) = CfaPattern().channel_at(x, y) == 1 ? 0.01f : 0.02f;
      noise(x, y) = sigma(x, y) * static_cast<float>(random.normal());
    }
  }
  Rgb value(size), predicted(size);
  solver::demosaic(noise.plane(), {}, {0, 0, 256, 256}, value.views());
  solver::demosaic_sigma(sigma.plane(), {}, {0, 0, 256, 256}, predicted.views());
  for (int c = 0; c < 3; ++c) {
    for (int phase = 0; phase < 4; ++phase) {
      double seen = 0, expected = 0;
      for (int y = 2 + phase / 2; y < 254; y += 2) {
        for (int x = 2 + phase % 2; x < 254; x += 2) {
          seen += std::pow(value.planes(x, y, c), 2);
          expected += std::pow(predicted.planes(x, y, c), 2);
        }
      }
      EXPECT_NEAR(std::sqrt(seen / expected), 1, 0.03) << "channel " << c << " phase " << phase;
    }
  }
}

}  // namespace
}  // namespace weft
