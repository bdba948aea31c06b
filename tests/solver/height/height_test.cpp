// SPDX-License-Identifier: Apache-2.0
#include "solver/height/height.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/oracles/oracle_rig.h"
#include "core/base/vec.h"
#include "tests/solver/height/surface.h"

namespace weft::solver {
namespace {

using test::all_finite;
using test::height_of;
using test::normals_of;
using test::planes_of;
using test::rms_error_px;
using test::SurfacePoint;
using test::weave_with_folds;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
const Size kSize = {256, 192};

test::Surface plane(double right, double down) {
  return [=](double x, double y) { return SurfacePoint{right * x + down * y, right, down}; };
}

Image<std::uint8_t> mask_of(Size size, const std::function<int(int, int)>& value) {
  Image<std::uint8_t> mask(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mask(x, y) = static_cast<std::uint8_t>(value(x, y));
  }
  return mask;
}

TEST(Height, OfAWeaveWithFoldsIsRightToSevenHundredthsOfAPixel) {
  const Height height = height_of(normals_of(kSize, weave_with_folds));
  EXPECT_EQ(height.method, HeightMethod::kDct);
  EXPECT_EQ(height.pixels, kSize.pixels());
  EXPECT_EQ(height.islands, 1);
  EXPECT_GT(test::rms_of(height.height_mm.plane()), 5) << "too flat to prove anything";
  EXPECT_LT(rms_error_px(height.height_mm.plane(), weave_with_folds), 0.07);
  EXPECT_LT(height.slope_residual_rms, 1e-4);
}

TEST(Height, LosesHardlyAnythingToOneDegreeOfNoise) {
  Image<float> normals = normals_of(kSize, weave_with_folds);
  const Height clean = height_of(normals);
  test::add_noise(normals, 1, 1);
  const Height noisy = height_of(normals);
  const double before = rms_error_px(clean.height_mm.plane(), weave_with_folds);
  const double after = rms_error_px(noisy.height_mm.plane(), weave_with_folds);
  EXPECT_LT(after - before, 0.02) << before << " px without, " << after << " px with noise";
  // The noise that no surface can have is left: a good part of the 0.012 to 0.03 of each slope.
  EXPECT_GT(noisy.slope_residual_rms, 0.005);
  EXPECT_LT(noisy.slope_residual_rms, 0.03);
}

TEST(Height, OfATiltedPlaneIsExactInMillimetresAndRisesTheRightWay) {
  for (const auto method : {HeightMethod::kDct, HeightMethod::kMultigrid, HeightMethod::kSeed}) {
    // Rises to the right and falls down the rows; 0.05 mm a pixel.
    const Height height =
        height_of(normals_of({301, 203}, plane(0.3, -0.2)), {.method = method, .mm_per_pixel = 0.05});
    for (const auto& [x, y] : {std::pair{0, 0}, {300, 0}, {0, 202}, {300, 202}, {150, 101}}) {
      const double want = 0.05 * (0.3 * (x - 150) - 0.2 * (y - 101));
      EXPECT_NEAR(height.height_mm(x, y), want, 2e-6) << "method " << int(method) << " at " << x << ", " << y;
    }
  }
}

TEST(Height, OfASphereCapIsTheSphere) {
  const auto sphere = [](double x, double y) {
    const double u = x - 48, v = y - 40, h = std::sqrt(100 * 100 - u * u - v * v);
    return SurfacePoint{h, -u / h, -v / h};
  };
  const Height height = height_of(normals_of({97, 81}, sphere));
  EXPECT_LT(rms_error_px(height.height_mm.plane(), sphere), 1e-3);
}

TEST(Height, OfASmallLinearBiasOfTheNormalsIsTheKnownBowl) {
  constexpr int kWidth = 4928;
  const double bias = std::tan(radians(0.3));
  const auto bowl = [=](double x, double) { return SurfacePoint{0, bias * (2 * x / (kWidth - 1) - 1), 0}; };
  const Height height = height_of(normals_of({kWidth, 8}, bowl));
  const double depth = height.height_mm(0, 4) - height.height_mm(kWidth / 2, 4);
  EXPECT_NEAR(depth, bias * (kWidth - 1) / 4, 1e-3);  // 6.5 pixels
}

TEST(Height, HasMeanZeroAndScalesWithThePixel) {
  const Image<float> normals = normals_of(kSize, weave_with_folds);
  const Height pixels = height_of(normals), millimetres = height_of(normals, {.mm_per_pixel = 0.04});
  EXPECT_NEAR(test::mean_of(pixels.height_mm.plane()), 0, 1e-5);
  for (int x = 0; x < kSize.width; x += 17) {
    EXPECT_NEAR(millimetres.height_mm(x, 100), 0.04 * pixels.height_mm(x, 100), 1e-6);
  }
}

TEST(Height, IsTheSameByBothExactMethodsForFramesOfAnyShape) {
  for (const Size size : {Size{1, 1}, {1, 97}, {83, 1}, {2, 2}, {3, 2}, {97, 89}, {74, 33}, {130, 40}}) {
    Image<float> normals = normals_of(size, plane(0, 0));
    test::add_noise(normals, 8, 3);
    const Height direct = height_of(normals, {.method = HeightMethod::kDct});
    const Height iterated = height_of(normals, {.method = HeightMethod::kMultigrid});
    EXPECT_LT(test::rms_difference(direct.height_mm.plane(), iterated.height_mm.plane()),
              2e-6 * test::rms_of(direct.height_mm.plane()) + 1e-9)
        << size.width << " x " << size.height;
    EXPECT_EQ(iterated.islands, 1);
  }
}

TEST(Height, HasTheSameBytesOnAnyNumberOfThreads) {
  Image<float> normals = normals_of({203, 170}, weave_with_folds);
  test::add_noise(normals, 2, 5);
  const Image<std::uint8_t> mask = mask_of(normals.size(), [](int x, int y) { return (x * 7 + y * 5) % 11; });
  for (const auto method : {HeightMethod::kDct, HeightMethod::kMultigrid, HeightMethod::kSeed}) {
    HeightOptions options = {.method = method, .threads = 1, .seed_relaxations = 10};
    const View<const std::uint8_t> inside =
        method == HeightMethod::kDct ? View<const std::uint8_t>() : mask.plane();
    const Height one = height_of(normals, options, inside);
    for (const int threads : {2, 7}) {
      options.threads = threads;
      const Height many = height_of(normals, options, inside);
      EXPECT_TRUE(test::same_bytes(one.height_mm.plane(), many.height_mm.plane())) << threads << " threads";
      EXPECT_EQ(one.slope_residual_rms, many.slope_residual_rms);
      EXPECT_EQ(one.residual, many.residual);
    }
  }
}

TEST(Height, AroundAHoleIsThatOfTheSurface) {
  const auto inside = [](int x, int y) { return std::hypot(x - 100, y - 90) > 40; };
  const Image<std::uint8_t> mask = mask_of(kSize, inside);
  Image<float> normals = normals_of(kSize, weave_with_folds);
  const Height height = height_of(normals, {}, mask.plane());
  EXPECT_EQ(height.method, HeightMethod::kMultigrid);
  EXPECT_LE(height.residual, 1e-8);
  EXPECT_EQ(height.islands, 1);
  double mean = 0, squares = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (!inside(x, y)) {
          EXPECT_EQ(height.height_mm(x, y), 0);
          continue;
        }
        const double error = height.height_mm(x, y) - weave_with_folds(x, y).height;
        const double pixels = static_cast<double>(height.pixels);
        pass == 0 ? mean += error / pixels : squares += (error - mean) * (error - mean) / pixels;
      }
    }
  }
  EXPECT_LT(std::sqrt(squares), 0.07);
}

TEST(Height, OfEveryIslandHasMeanZeroAndALonePixelIsZero) {
  // Left of column 40, right of column 60 and alone in the gap, where two pixels touch at a corner only.
  const Image<std::uint8_t> mask = mask_of({100, 50}, [](int x, int y) {
    return x < 40 || x >= 60 || (x == 50 && y == 20) || (x == 51 && y == 21);
  });
  const Height height = height_of(normals_of(mask.size(), weave_with_folds), {}, mask.plane());
  EXPECT_EQ(height.islands, 4);
  EXPECT_EQ(height.pixels, 80 * 50 + 2);
  EXPECT_NEAR(test::mean_of(height.height_mm.plane().crop({0, 0, 40, 50})), 0, 1e-5);
  EXPECT_NEAR(test::mean_of(height.height_mm.plane().crop({60, 0, 100, 50})), 0, 1e-5);
  EXPECT_EQ(height.height_mm(50, 20), 0);
  EXPECT_EQ(height.height_mm(51, 21), 0);
}

TEST(Height, LetsABadPatchOfLittleWeightYield) {
  Image<float> normals = normals_of({90, 80}, weave_with_folds);
  const auto is_bad = [](int x, int y) { return std::hypot(x - 45, y - 40) < 8; };
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 90; ++x) {
      if (is_bad(x, y)) normals(x, y, 0) = 0.7f;
    }
  }
  const Image<std::uint8_t> weight =
      mask_of(normals.size(), [&](int x, int y) { return is_bad(x, y) ? 1 : 255; });
  const double alike = rms_error_px(height_of(normals).height_mm.plane(), weave_with_folds);
  const double weighted =
      rms_error_px(height_of(normals, {}, weight.plane()).height_mm.plane(), weave_with_folds);
  EXPECT_LT(weighted, 0.2 * alike) << weighted << " px with weights, " << alike << " px without";
}

TEST(Height, TakesAMaskOfOneWeightAsNoMask) {
  const Image<float> normals = normals_of({64, 48}, weave_with_folds);
  const Image<std::uint8_t> mask = mask_of(normals.size(), [](int, int) { return 255; });
  const Height masked = height_of(normals, {}, mask.plane());
  EXPECT_EQ(masked.method, HeightMethod::kDct);
  EXPECT_TRUE(test::same_bytes(masked.height_mm.plane(), height_of(normals).height_mm.plane()));
}

TEST(Height, ClampsWhatIsSteeperThanAskedAndCountsIt) {
  Image<float> normals = normals_of({40, 30}, plane(0, 0));
  const Vec3 steep[] = {{1, 0, 0}, {-0.9, 0.1, -0.4}, {0.99, 0, 0.05}, {1e30, 1e30, 1e-30}};
  int x = 5;
  for (const Vec3 n : steep) {
    normals(x, 15, 0) = static_cast<float>(n.x);
    normals(x, 15, 1) = static_cast<float>(n.y);
    normals(x, 15, 2) = static_cast<float>(n.z);
    x += 7;
  }
  const Height height = height_of(normals, {.steepest_deg = 60});
  EXPECT_EQ(height.clamped, 4);
  EXPECT_EQ(height.pixels, 40 * 30);
  for (x = 0; x < 40; ++x) EXPECT_LT(std::abs(height.height_mm(x, 15)), std::tan(radians(60.0)));
  EXPECT_EQ(height_of(normals_of({40, 30}, plane(1, 1))).clamped, 0);
}

TEST(Height, TakesRubbishAsMaskedOutAndNeverReturnsIt) {
  Image<float> normals = normals_of({60, 40}, weave_with_folds);
  const float rubbish[][3] = {{kNaN, 0, 1}, {0, kInfinity, 1}, {0, 0, -kInfinity}, {0, 0, 0},
                              {0, 0, -1},   {0, kNaN, kNaN},   {-0.0f, 0, -0.0f}};
  int x = 3;
  for (const auto& n : rubbish) {
    for (int c = 0; c < 3; ++c) normals(x, 20, c) = n[c];
    x += 8;
  }
  for (const auto method : {HeightMethod::kAutomatic, HeightMethod::kMultigrid, HeightMethod::kSeed}) {
    const Height height = height_of(normals, {.method = method});
    EXPECT_NE(height.method, HeightMethod::kDct);
    EXPECT_EQ(height.pixels, 60 * 40 - 7);
    EXPECT_TRUE(all_finite(height.height_mm.plane()));
    EXPECT_EQ(height.height_mm(3, 20), 0);
  }
}

TEST(Height, IsFiniteForAnyFloats) {
  test::Random random(7);
  const float kinds[] = {0, -0.0f, 1, -1, 1e-45f, 1e38f, -1e38f, 1e-20f, kNaN, kInfinity, 0.5f, 0.1f};
  for (int trial = 0; trial < 20; ++trial) {
    Image<float> normals({23, 17}, 3);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 17; ++y) {
        for (int x = 0; x < 23; ++x)
          normals(x, y, c) = kinds[static_cast<std::size_t>(random.uniform() * 12)];
      }
    }
    const Height height = height_of(normals, {.mm_per_pixel = 1e6, .steepest_deg = 89.99});
    EXPECT_TRUE(all_finite(height.height_mm.plane())) << "trial " << trial;
    EXPECT_TRUE(std::isfinite(height.slope_residual_rms) && std::isfinite(height.residual));
  }
}

TEST(Height, RefusesWhatCannotBeMeant) {
  const Image<float> normals = normals_of({20, 10}, plane(0, 0));
  const auto kind_of = [&](const std::array<View<const float>, 3>& planes, const HeightOptions& options,
                           View<const std::uint8_t> mask = {}) {
    const Result<Height> height = height_from_normals(planes, mask, options);
    EXPECT_FALSE(height.has_value());
    return height ? ErrorKind::kInternal : height.error().kind;
  };
  const auto planes = planes_of(normals);
  EXPECT_EQ(kind_of({}, {}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of({planes[0], planes[1], planes[2].crop({0, 0, 19, 10})}, {}), ErrorKind::kUsage);
  for (const double mm : {0.0, -1.0, 1e300, std::nan("")}) {
    EXPECT_EQ(kind_of(planes, {.mm_per_pixel = mm}), ErrorKind::kUsage) << mm;
  }
  for (const double deg : {0.0, 90.0, std::nan("")}) {
    EXPECT_EQ(kind_of(planes, {.steepest_deg = deg}), ErrorKind::kUsage) << deg;
  }
  EXPECT_EQ(kind_of(planes, {.tolerance = -1}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of(planes, {.most_cycles = 0}), ErrorKind::kUsage);
  const Image<std::uint8_t> half = mask_of({20, 10}, [](int x, int) { return x < 10; });
  const Image<std::uint8_t> small = mask_of({19, 10}, [](int, int) { return 1; });
  const Image<std::uint8_t> none = mask_of({20, 10}, [](int, int) { return 0; });
  EXPECT_EQ(kind_of(planes, {}, small.plane()), ErrorKind::kUsage);
  EXPECT_EQ(kind_of(planes, {.method = HeightMethod::kDct}, half.plane()), ErrorKind::kUsage);
  EXPECT_EQ(kind_of(planes, {}, none.plane()), ErrorKind::kBadData);
  const Image<float> nothing({20, 10}, 3);
  EXPECT_EQ(kind_of(planes_of(nothing), {}), ErrorKind::kBadData);
}

TEST(SeedHeight, FollowsTheFoldsOnceItsSignsAreRight) {
  const Height height =
      height_of(normals_of(kSize, weave_with_folds), {.method = HeightMethod::kSeed, .seed_relaxations = 60});
  EXPECT_EQ(height.method, HeightMethod::kSeed);
  EXPECT_LT(rms_error_px(height.height_mm.plane(), weave_with_folds), 2.5);
}

TEST(SeedHeight, FailsWithTheSignsAsPrinted) {
  const Height height =
      height_of(normals_of(kSize, weave_with_folds),
                {.method = HeightMethod::kSeed, .seed_relaxations = 60, .seed_signs_as_printed = true});
  EXPECT_GT(rms_error_px(height.height_mm.plane(), weave_with_folds), 5);
}

}  // namespace
}  // namespace weft::solver
