// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_by_lights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace weft::solver {
namespace {

constexpr std::size_t kMostPixels = 1000;
// Step of a light's direction that slopes are taken from.
constexpr double kLightTurn = 1e-5;

using Values = Eigen::Matrix<double, kLobeParameters, 1>;
using ValuesMatrix = Eigen::Matrix<double, kLobeParameters, kLobeParameters>;

// Slopes of one reading.
struct Slopes {
  double weight = 0;
  Vec3 by_b;
  Values by_values = Values::Zero();
  std::array<double, LobeByLights::kErrors> by_errors = {};
};

class Slope {
 public:
  Slope(const LobeFit& fit, const LobeParameters& fitted) : fit_(fit), fitted_(fitted) {
    for (std::size_t p = 0; p < kLobeParameters; ++p) {
      if (fitted[p]) nudged_[p] = nudged(fit.lobe, static_cast<LobeParameter>(p));
    }
  }

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
    slopes.by_errors[0] = m.x;
    const std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      LitFrom turned(normalized(r.from.light + kLightTurn * axes[axis]), r.from.view, r.from.lobe_share);
      turned.channel = r.from.channel;
      slopes.by_errors[1 + axis] = (modelled(fit_.lobe, b, turned, yarn) - m.x) / kLightTurn;
    }
    return slopes;
  }

 private:
  const LobeFit& fit_;
  const LobeParameters& fitted_;
  std::array<NudgedLobe, kLobeParameters> nudged_;
};

}  // namespace

LobeByLights::LobeByLights(const LobeSamples& samples, const LobeFit& fit, const LobeParameters& fitted) {
  const std::size_t pixels = samples.pixels(), lights = samples.lights();
  const std::size_t readings_of_pixel = lights * samples.states();
  const Slope slope(fit, fitted);
  ValuesMatrix information = ValuesMatrix::Zero();
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(kLobeParameters),
                                                static_cast<Eigen::Index>(kErrors * lights));
  std::vector<Slopes> slopes(readings_of_pixel);
  const std::size_t count = std::min(pixels, kMostPixels);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = i * pixels / count;
    const auto readings = samples.of(pixel);
    PixelSystem system;
    std::array<Vec3, kLobeParameters> by_both = {};
    for (std::size_t k = 0; k < readings_of_pixel; ++k) {
      slopes[k] = {};
      if (readings[k].weight == 0) continue;
      slopes[k] = slope.of(readings[k], pixel);
      const Slopes& s = slopes[k];
      system.add(s.by_b, s.weight, 0);
      for (std::size_t p = 0; p < kLobeParameters; ++p)
        by_both[p] = by_both[p] + (s.weight * s.by_values[static_cast<Eigen::Index>(p)]) * s.by_b;
    }
    system.regularise();
    for (Vec3& each : by_both) each = system.solved(each);
    for (std::size_t k = 0; k < readings_of_pixel; ++k) {
      const Slopes& s = slopes[k];
      if (s.weight == 0) continue;
      // What the pixel's own normal and albedo do not take up.
      Values left = s.by_values;
      for (std::size_t p = 0; p < kLobeParameters; ++p)
        left[static_cast<Eigen::Index>(p)] -= dot(by_both[p], s.by_b);
      information += s.weight * left * left.transpose();
      for (std::size_t e = 0; e < kErrors; ++e)
        mixed.col(static_cast<Eigen::Index>(kErrors * (k % lights) + e)) +=
            (s.weight * s.by_errors[e]) * left;
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
  const ValuesMatrix values = change * of_errors * change.transpose();
  LobeCovariance covariance;
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    for (std::size_t q = 0; q < kLobeParameters; ++q)
      covariance[p][q] = values(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q));
  }
  return covariance;
}

}  // namespace weft::solver
