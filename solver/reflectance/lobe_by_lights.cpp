// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_by_lights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "solver/reflectance/reading_slopes.h"

namespace weft::solver {
namespace {

// Pixels of the sample that stand for all.
constexpr std::size_t kMostPixels = 1000;
// Step of a light's direction that slopes are taken from.
constexpr double kLightTurn = 1e-5;

constexpr int kValues = kLobeParameters;
using Slopes = ReadingSlopes<kValues>;

class Slope {
 public:
  Slope(const LobeFit& fit, const LobeParameters& fitted)
      : fit_(fit), fitted_(fitted), nudged_(nudged(fit.lobe, fitted)) {}

  Slopes of(const LobeReading& r, std::size_t pixel) const {
    const Vec3 b = fit_.b[pixel];
    const double yarn = fit_.yarn[pixel];
    const ModelledReading m = modelled_with_derivative(fit_.lobe, b, r.from, yarn);
    Slopes slopes;
    slopes.weight = r.weight * huber_weight((r.x - m.x) * std::sqrt(r.weight));
    slopes.by_b = m.by_b;
    for (std::size_t p = 0; p < kLobeParameters; ++p) {
      if (!fitted_[p]) continue;
      slopes.by_values[static_cast<Eigen::Index>(p)] =
          (modelled(nudged_[p].lobe, b, r.from, yarn) - m.x) / nudged_[p].by;
    }
    slopes.by_errors = slopes_by_errors(fit_.lobe, r, b, yarn, m.x);
    return slopes;
  }

 private:
  const LobeFit& fit_;
  const LobeParameters& fitted_;
  NudgedLobes nudged_;
};

}  // namespace

std::array<double, LobeByLights::kErrors> slopes_by_errors(const Lobe& lobe, const LobeReading& reading,
                                                           Vec3 b, double yarn, double of_model) {
  std::array<double, LobeByLights::kErrors> slopes = {of_model};
  const std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  const LitFrom& from = reading.from;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    LitFrom turned(normalized(from.light + kLightTurn * axes[axis]), from.view, from.lobe_share);
    turned.channel = from.channel;
    slopes[1 + axis] = (modelled(lobe, b, turned, yarn) - of_model) / kLightTurn;
  }
  return slopes;
}

LobeByLights::LobeByLights(const LobeSamples& samples, const LobeFit& fit, const LobeParameters& fitted) {
  const std::size_t pixels = samples.pixels(), lights = samples.lights();
  const std::size_t readings_of_pixel = lights * samples.states();
  const Slope slope(fit, fitted);
  Eigen::Matrix<double, kValues, kValues> information = Eigen::Matrix<double, kValues, kValues>::Zero();
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(kValues, static_cast<Eigen::Index>(kErrors * lights));
  std::vector<Slopes> slopes(readings_of_pixel);
  const std::size_t count = std::min(pixels, kMostPixels);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = i * pixels / count;
    const auto readings = samples.of(pixel);
    for (std::size_t k = 0; k < readings_of_pixel; ++k)
      slopes[k] = readings[k].weight > 0 ? slope.of(readings[k], pixel) : Slopes();
    take_out_pixel(std::span(slopes));
    for (std::size_t k = 0; k < readings_of_pixel; ++k) {
      const Slopes& s = slopes[k];
      information += s.weight * s.by_values * s.by_values.transpose();
      for (std::size_t e = 0; e < kErrors; ++e)
        mixed.col(static_cast<Eigen::Index>(kErrors * (k % lights) + e)) +=
            (s.weight * s.by_errors[e]) * s.by_values;
    }
  }
  const Eigen::MatrixXd change =
      Eigen::MatrixXd(information).completeOrthogonalDecomposition().pseudoInverse() * mixed;
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    for (Eigen::Index e = 0; e < change.cols(); ++e)
      change_[p].push_back(fitted[p] ? change(static_cast<Eigen::Index>(p), e) : 0);
  }
}

LobeCovariance LobeByLights::covariance_of(std::span<const double> errors) const {
  const auto n = static_cast<Eigen::Index>(this->errors());
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> of_errors(
      errors.data(), n, n);
  Eigen::MatrixXd change(static_cast<Eigen::Index>(kLobeParameters), n);
  for (std::size_t p = 0; p < kLobeParameters; ++p)
    change.row(static_cast<Eigen::Index>(p)) = Eigen::Map<const Eigen::RowVectorXd>(change_[p].data(), n);
  const Eigen::Matrix<double, kValues, kValues> values = change * of_errors * change.transpose();
  LobeCovariance covariance;
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    for (std::size_t q = 0; q < kLobeParameters; ++q)
      covariance[p][q] = values(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q));
  }
  return covariance;
}

}  // namespace weft::solver
