// SPDX-License-Identifier: Apache-2.0
#include "calibration/color/color_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "calibration/color/chart_reference.h"
#include "core/rig/color_transform.h"

namespace weft::calibration {
namespace {

using testing::HasSubstr;

constexpr Mat3 kCameraFromRec709 = {{{0.75, 0.2, 0.05}, {0.1, 0.8, 0.1}, {0.02, 0.18, 0.8}}};

// Inverse of kCameraFromRec709 by Cramer's rule.
Mat3 truth() {
  const Mat3& m = kCameraFromRec709;
  Mat3 inverse = {};
  const auto minor = [&](std::size_t r, std::size_t c) {
    const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double det = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) inverse[r][c] = minor(c, r) / det;
  }
  return inverse;
}

std::vector<ChartSample> samples_of(double scale, double shading) {
  std::vector<ChartSample> samples;
  const ChartReference chart = published_chart();
  for (int i = 0; i < kChartPatches; ++i) {
    ChartSample s;
    s.reference = chart[static_cast<std::size_t>(i)];
    s.u = 2.0 * (i % kChartColumns) / (kChartColumns - 1) - 1;
    s.v = 2.0 * (i / kChartColumns) / (kChartRows - 1) - 1;
    const double light = std::exp(shading * (s.u + 0.5 * s.v + 0.3 * s.u * s.u)) / scale;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& row = kCameraFromRec709[c];
      s.camera[c] = light * (row[0] * s.reference[0] + row[1] * s.reference[1] + row[2] * s.reference[2]);
    }
    samples.push_back(s);
  }
  return samples;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(ColorFit, FindsTheMatrixOfACameraThatIsOne) {
  const auto fit = fit_color(samples_of(0.8, 0), ChartLight::kEven, true);
  ASSERT_TRUE(fit) << fit.error().message();
  const Mat3 m = truth();
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(fit->rec709_from_camera[r][c], m[r][c], 1e-5);
  }
  EXPECT_NEAR(fit->scale, 0.8, 1e-5);
  EXPECT_LT(*std::max_element(fit->off.begin(), fit->off.end()), 1e-3);
  EXPECT_LT(*std::max_element(fit->left_out.begin(), fit->left_out.end()), 1e-3);
  EXPECT_GT(mean(fit->before), 4);
}

TEST(ColorFit, FindsItUnderALampThatStandsToOneSide) {
  const auto fit = fit_color(samples_of(1.3, 0.2), ChartLight::kShaded, false);
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_LT(*std::max_element(fit->off.begin(), fit->off.end()), 1e-3);
  EXPECT_NEAR(fit->light[5] / fit->light[0], std::exp(0.2 * 2), 1e-3);
  EXPECT_TRUE(fit->left_out.empty());
}

// Samples of a camera whose channels no matrix takes to the chart's colours.
std::vector<ChartSample> uneven_samples() {
  std::vector<ChartSample> samples = samples_of(1, 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      samples[i].camera[c] *= 1 + 0.05 * std::sin(static_cast<double>(7 * i + 2 * c));
  }
  return samples;
}

TEST(ColorFit, LeavesEachPatchOutByItselfWhateverTheirOrder) {
  std::vector<ChartSample> samples = uneven_samples();
  const auto fit = fit_color(samples, ChartLight::kEven, true);
  std::reverse(samples.begin(), samples.end());
  const auto reversed = fit_color(samples, ChartLight::kEven, true);
  ASSERT_TRUE(fit && reversed);
  ASSERT_EQ(fit->left_out.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    EXPECT_NEAR(fit->left_out[i], reversed->left_out[samples.size() - 1 - i], 1e-3) << "patch " << i;
}

TEST(ColorFit, KeepsWhiteWhite) {
  const std::vector<ChartSample> samples = uneven_samples();
  const auto fit = fit_color(samples, ChartLight::kEven, false);
  ASSERT_TRUE(fit);
  for (const auto& row : fit->rec709_from_camera) EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-12);
}

TEST(ColorFit, SaysHowFarItMayBeOff) {
  // Over many draws of noise, the scatter of an entry against its predicted standard deviation.
  std::mt19937 random(5);
  const Mat3 m = truth();
  double square = 0;
  constexpr int kDraws = 40;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<ChartSample> samples = samples_of(1, 0);
    for (ChartSample& s : samples) {
      for (double& v : s.camera) v *= 1 + 0.01 * (static_cast<double>(random() % 20001) / 10000 - 1);
    }
    const auto fit = fit_color(samples, ChartLight::kEven, false);
    ASSERT_TRUE(fit);
    const std::size_t entry = 1;  // green in red
    const double sigma = std::sqrt(fit->covariance[entry * 9 + entry]);
    square += std::pow((fit->rec709_from_camera[0][1] - m[0][1]) / sigma, 2) / kDraws;
    double row = 0;  // an entry's covariance with its row is nothing: rows sum to 1
    for (std::size_t k = 0; k < 3; ++k) row += fit->covariance[entry * 9 + k];
    EXPECT_NEAR(row, 0, 1e-12);
  }
  EXPECT_GT(square, 0.2);
  EXPECT_LT(square, 2.5);
}

TEST(ColorFit, DoesBetterByCiede2000ThanLinearLeastSquaresOfRgb) {
  // A camera that no matrix describes: red bends with saturation.
  std::vector<ChartSample> samples = samples_of(1, 0);
  for (ChartSample& s : samples) s.camera[0] += 0.05 * (s.camera[0] - s.camera[2]) * s.camera[0];
  const auto fit = fit_color(samples, ChartLight::kEven, false);
  ASSERT_TRUE(fit);
  // Nearby matrices with the same rows are worse in the sum of squares.
  const auto cost = [&](const Mat3& m) {
    double sum = 0;
    for (const ChartSample& s : samples) {
      const Vec3 r = m * Vec3{s.camera[0], s.camera[1], s.camera[2]};
      const double e = ciede2000_of({fit->scale * r.x, fit->scale * r.y, fit->scale * r.z}, s.reference);
      sum += e * e;
    }
    return sum;
  };
  const double best = cost(fit->rec709_from_camera);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (const double step : {-0.02, 0.02}) {
        Mat3 moved = fit->rec709_from_camera;
        if (c == r) continue;
        moved[r][c] += step;
        moved[r][r] -= step;
        EXPECT_GT(cost(moved), best) << "row " << r << ", column " << c;
      }
    }
  }
}

TEST(ColorFit, SeesTheShadowOfAHand) {
  std::vector<ChartSample> samples = samples_of(1, 0.1);
  const std::vector<std::size_t> shaded = {0, 1, 6, 7, 12};
  for (const std::size_t i : shaded) {
    for (double& v : samples[i].camera) v *= 0.6;
  }
  const auto light = light_of_each(samples);
  ASSERT_TRUE(light);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool is_shaded = std::find(shaded.begin(), shaded.end(), i) != shaded.end();
    EXPECT_NEAR((*light)[i], is_shaded ? 0.6 : 1.0, 0.08) << "patch " << i + 1;
  }
}

TEST(ColorFit, RefusesTooFewPatchesAndPatchesOfOneColour) {
  std::vector<ChartSample> few = samples_of(1, 0);
  few.resize(8);
  const auto fit = fit_color(few, ChartLight::kEven, false);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message(), HasSubstr("too few patches"));
  std::vector<ChartSample> alike(12, samples_of(1, 0)[20]);
  EXPECT_FALSE(fit_color(alike, ChartLight::kEven, false));
  // Greys that differ from each other by a thousandth of noise: a matrix that fits them turns red to grey.
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 1e-3);
  std::vector<ChartSample> greys(24);
  for (std::size_t i = 0; i < greys.size(); ++i) {
    greys[i].reference.fill(0.03 * static_cast<double>(i + 1));
    for (double& v : greys[i].camera) v = greys[i].reference[0] * (1 + noise(random));
  }
  const auto of_greys = fit_color(greys, ChartLight::kEven, false);
  ASSERT_FALSE(of_greys);
  EXPECT_THAT(of_greys.error().message(), HasSubstr("too much alike"));
  std::vector<ChartSample> black(12);
  EXPECT_FALSE(fit_color(black, ChartLight::kEven, false));
}

TEST(ColorCurve, FollowsACameraThatBendsLevels) {
  std::vector<ChartSample> samples = samples_of(1, 0);
  for (ChartSample& s : samples) {
    for (double& v : s.camera) v = 0.9 * v + 0.15 * v * v;
  }
  const auto matrix = fit_color(samples, ChartLight::kEven, false);
  const auto curve = fit_color_curve(samples, 1);
  ASSERT_TRUE(matrix && curve);
  ColorTransform transform;
  transform.curve = *curve;
  double luminance_off = 0, by_matrix = 0;
  for (const ChartSample& s : samples) {
    luminance_off = std::max(luminance_off, std::abs(xyz_of_rec709(rec709_of_camera(transform, s.camera))[1] -
                                                     xyz_of_rec709(s.reference)[1]));
    const Vec3 m = matrix->rec709_from_camera * Vec3{s.camera[0], s.camera[1], s.camera[2]};
    const Rgb rgb = {matrix->scale * m.x, matrix->scale * m.y, matrix->scale * m.z};
    by_matrix = std::max(by_matrix, std::abs(xyz_of_rec709(rgb)[1] - xyz_of_rec709(s.reference)[1]));
  }
  EXPECT_LT(luminance_off, 0.015);
  EXPECT_GT(by_matrix, 0.02) << "no matrix follows it";
}

TEST(ColorCurve, IsTheIdentityUnlessItIsFitted) {
  ColorTransform transform;
  transform.curve = ColorCurve();
  for (const Rgb& rgb : {Rgb{0.2, 0.5, 0.7}, Rgb{0, 0, 0}, Rgb{-0.01, 0.2, 0.3}}) {
    const Rgb same = rec709_of_camera(transform, rgb);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(same[c], rgb[c], 1e-6);
  }
}

TEST(Rec709OfCamera, KeepsWhatIsBelowNothing) {
  ColorTransform transform;
  transform.rec709_from_camera = truth();
  const Rgb out = rec709_of_camera(transform, {0.01, 0.3, 0.02});
  EXPECT_LT(out[0], 0);
}

}  // namespace
}  // namespace weft::calibration
