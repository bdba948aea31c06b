// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/demosaic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/oracles/oracle_rig.h"
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

// What is seen of a cloth through the filters, with errors of a known standard deviation.
struct Seen {
  Image<float> truth, mosaic, sigma;

  template <typename Colour>
  Seen(Size size, float deviation, const Colour& colour_at) : truth(size, 3), mosaic(size), sigma(size) {
    test::Random random(9);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const std::array<double, 3> colour = colour_at(x, y);
        for (int c = 0; c < 3; ++c) truth(x, y, c) = static_cast<float>(colour[static_cast<std::size_t>(c)]);
        sigma(x, y) = deviation;
        mosaic(x, y) =
            truth(x, y, CfaPattern().channel_at(x, y)) + deviation * static_cast<float>(random.normal());
      }
    }
  }

  // Root of the mean over the sites that did not measure channel c, away from the edges.
  template <typename Square>
  double rms_where_interpolated(int c, const Square& square_at) const {
    double sum = 0, count = 0;
    for (int y = 4; y < truth.height() - 4; ++y) {
      for (int x = 4; x < truth.width() - 4; ++x) {
        if (CfaPattern().channel_at(x, y) == c) continue;
        sum += square_at(x, y);
        ++count;
      }
    }
    return std::sqrt(sum / count);
  }
  double rms_error(int c, const Image<float>& rgb) const {
    return rms_where_interpolated(c,
                                  [&](int x, int y) { return std::pow(rgb(x, y, c) - truth(x, y, c), 2); });
  }
};

// Red warp and blue weft, ten pixels a yarn.
std::array<double, 3> dyed_twill(int x, int y) {
  const bool is_warp = (x / 10 + y / 10) % 4 < 2;
  return is_warp ? std::array{0.6, 0.04, 0.05} : std::array{0.03, 0.06, 0.45};
}

TEST(Demosaic, KeepsTheColoursOfDyedYarnsApart) {
  const Seen seen({160, 120}, 0.001f, dyed_twill);
  test::on_every_target([&] {
    Rgb rgb(seen.mosaic.size()), sigma(seen.mosaic.size());
    solver::demosaic(seen.mosaic.plane(), seen.sigma.plane(), {}, {0, 0, 160, 120}, rgb.views(),
                     sigma.views());
    EXPECT_LE(seen.rms_error(0, rgb.planes), 0.02);  // bilinear: 0.10
    EXPECT_LE(seen.rms_error(1, rgb.planes), 0.01);  // gradient-corrected: 0.043
    EXPECT_LE(seen.rms_error(2, rgb.planes), 0.02);  // bilinear: 0.07
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        for (int c = 0; c < 3; ++c) ASSERT_GE(rgb.planes(x, y, c), 0) << x << ", " << y << " channel " << c;
      }
    }
  });
}

TEST(Demosaic, FollowsAGreyTextureOfTwoPixels) {
  test::Random random(10);
  Image<float> grain({129, 97});
  for (int y = 0; y < 97; ++y) {
    for (int x = 0; x < 129; ++x) grain(x, y) = 0.1f * static_cast<float>(random.normal());
  }
  const Seen seen({128, 96}, 0, [&](int x, int y) {
    const double grey = 0.5 + grain(x, y) + grain(x + 1, y) + grain(x, y + 1) + grain(x + 1, y + 1);
    return std::array{grey, grey, grey};
  });
  Rgb rgb(seen.mosaic.size());
  solver::demosaic(seen.mosaic.plane(), {}, {0, 0, 128, 96}, rgb.views());
  // The mean of four neighbours is off by 0.122; with the whole gradient taken off, by 0.050.
  EXPECT_LE(seen.rms_error(1, rgb.planes), 0.09);
}

TEST(DemosaicSigma, IsTheErrorBetweenDyedYarns) {
  const Seen seen({160, 120}, 0.001f, dyed_twill);
  Rgb rgb(seen.mosaic.size()), sigma(seen.mosaic.size());
  solver::demosaic(seen.mosaic.plane(), seen.sigma.plane(), {}, {0, 0, 160, 120}, rgb.views(), sigma.views());
  for (int c = 0; c < 3; ++c) {
    const double stated =
        seen.rms_where_interpolated(c, [&](int x, int y) { return std::pow(sigma.planes(x, y, c), 2); });
    const double ratio = stated / seen.rms_error(c, rgb.planes);
    EXPECT_GT(ratio, 1 / 1.5) << "channel " << c;
    EXPECT_LT(ratio, 1.5) << "channel " << c;
  }
}

TEST(DemosaicSigma, OfAMeasuredSiteIsItsOwn) {
  const Seen seen({32, 16}, 0.001f, dyed_twill);
  Rgb rgb(seen.mosaic.size()), sigma(seen.mosaic.size());
  solver::demosaic(seen.mosaic.plane(), seen.sigma.plane(), {}, {0, 0, 32, 16}, rgb.views(), sigma.views());
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      ASSERT_FLOAT_EQ(sigma.planes(x, y, CfaPattern().channel_at(x, y)), 0.001f) << x << ", " << y;
    }
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
  solver::demosaic(noise.plane(), sigma.plane(), {}, {0, 0, 256, 256}, value.views(), predicted.views());
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
