// SPDX-License-Identifier: Apache-2.0
#include "solver/deblur/filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::solver {
namespace {

constexpr int kFrequencies = 256;  // from 0 to Nyquist's

double square(double x) {
  return x * x;
}

// Sum of squares of the weights along one axis.
double energy(const DeblurFilter& filter) {
  double sum = square(static_cast<double>(filter.weights[0]));
  for (std::size_t i = 1; i < filter.weights.size(); ++i)
    sum += 2 * square(static_cast<double>(filter.weights[i]));
  return sum;
}

double centre(const DeblurFilter& filter) {
  return square(static_cast<double>(filter.weights[0]));
}

// Weights of a Gaussian at whole pixels, at 0 and beyond; sum 1 with those at the other side.
using Taps = std::array<double, 4 * kDeblurReach + 1>;

Taps sampled_gaussian(double width_px) {
  Taps taps = {1};
  double sum = 1;
  for (std::size_t k = 1; k < taps.size(); ++k) {
    taps[k] = std::exp(-0.5 * square(static_cast<double>(k) / width_px));
    sum += 2 * taps[k];
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

double variance(const Taps& taps) {
  double sum = 0;
  for (std::size_t k = 1; k < taps.size(); ++k) sum += 2 * taps[k] * square(static_cast<double>(k));
  return sum;
}

// The sampled Gaussian with a standard deviation, narrower samples having a smaller one.
Taps taps_of(double sigma_px) {
  double narrow = 0.01, wide = kDeblurReach;
  for (int i = 0; i < 40; ++i) {
    const double middle = (narrow + wide) / 2;
    (variance(sampled_gaussian(middle)) < square(sigma_px) ? narrow : wide) = middle;
  }
  return sampled_gaussian(wide);
}

// What a blur leaves of a frequency, radians a pixel.
double left_at(const Taps& taps, double frequency) {
  double sum = taps[0];
  for (std::size_t k = 1; k < taps.size(); ++k)
    sum += 2 * taps[k] * std::cos(static_cast<double>(k) * frequency);
  return sum;
}

}  // namespace

double DeblurFilter::kept_variance() const {
  return square(energy(*this));
}

double DeblurFilter::added_variance() const {
  return kept_variance() - 2 * centre(*this) + 1;
}

double DeblurFilter::added_covariance() const {
  return centre(*this) - 1;
}

DeblurFilter deblur_filter(double sigma_px, double noise) {
  constexpr int kWeights = kDeblurReach + 1;
  using Weights = Eigen::Matrix<double, kWeights, 1>;
  Eigen::Matrix<double, kWeights, kWeights> normal = Eigen::Matrix<double, kWeights, kWeights>::Zero();
  Weights right = Weights::Zero(), at_zero = Weights::Constant(2);
  at_zero[0] = 1;
  const Taps blur = taps_of(sigma_px);
  for (int i = 0; i < kFrequencies; ++i) {
    const double w = std::numbers::pi * (i + 0.5) / kFrequencies;
    const double left = left_at(blur, w);
    Weights cosines;
    for (int k = 0; k < kWeights; ++k) cosines[k] = at_zero[k] * std::cos(k * w);
    normal += (left * left + noise) * cosines * cosines.transpose();
    right += left * cosines;
  }
  // Least squares under the constraint that the weights sum to 1.
  const auto solver = normal.ldlt();
  const Weights free = solver.solve(right), towards = solver.solve(at_zero);
  const Weights weights = free + (1 - at_zero.dot(free)) / at_zero.dot(towards) * towards;
  DeblurFilter filter;
  for (int k = 0; k < kWeights; ++k)
    filter.weights[static_cast<std::size_t>(k)] = static_cast<float>(weights[k]);
  return filter;
}

}  // namespace weft::solver
