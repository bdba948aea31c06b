// SPDX-License-Identifier: Apache-2.0
#include "solver/diagnosis/robust_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/statistics.h"
#include "solver/in_double/pixel.h"

namespace weft::solver {
namespace {

// Below this share of the albedo a deviation is noise: weights stay finite.
constexpr double kSmallDeviation = 0.002;
constexpr double kSettled = 1e-4;           // change of b over the albedo
constexpr double kLeastDeterminant = 1e-6;  // over the cubed trace
constexpr std::size_t kFewestReadings = 5;
// A pixel whose bright readings stand out of the noise by less says nothing about lights.
constexpr double kLeastSignal = 10;

}  // namespace

LightModel LightModel::as_calibrated(std::size_t lights) {
  LightModel model = {std::vector<std::size_t>(lights), std::vector<double>(lights, 1.0)};
  std::iota(model.frame.begin(), model.frame.end(), std::size_t{0});
  return model;
}

double RobustFit::predicted(std::size_t k) const {
  return std::max(0.0, dot(l_[k], b_));
}

double RobustFit::deviation() const {
  double sum = 0;
  int count = 0;
  for (std::size_t k = 0; k < x_.size(); ++k) {
    if (!usable_[k]) continue;
    sum += std::abs(residual(k));
    ++count;
  }
  return sum / count;
}

bool RobustFit::fit(const Evidence& evidence, std::size_t pixel, const LightModel& model,
                    std::size_t left_out, int rounds) {
  const std::size_t lights = evidence.lights;
  l_.resize(lights);
  x_.resize(lights);
  usable_.assign(lights, 0);
  finite_.clear();
  double dimmest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < lights; ++k) {
    const EvidenceRow& row = evidence.at(pixel, k);
    l_[k] = row.direction;
    x_[k] = evidence.at(pixel, model.frame[k]).reading / (row.strength * model.gain[k]);
    if (!std::isfinite(x_[k]) || !(model.gain[k] > 0) || !(row.strength > 0)) continue;
    usable_[k] = 1;
    finite_.push_back(x_[k]);
    dimmest = std::min(dimmest, row.strength);
  }
  if (finite_.size() < kFewestReadings) return false;
  const auto rank = static_cast<std::size_t>(bright_rank(finite_.size()));
  const double bright = value_of_rank<double>(finite_, finite_.size() - rank);
  const double floor = evidence.noise ? std::sqrt(evidence.noise->floor + evidence.noise->shared) : 0;
  if (!(bright * dimmest > kLeastSignal * floor) || !(bright > 0)) return false;
  std::size_t used = 0;
  for (std::size_t k = 0; k < lights; ++k) {
    usable_[k] = usable_[k] && x_[k] >= kShadowShare * bright;
    used += usable_[k] && k != left_out;
  }
  if (used < kFewestReadings) return false;

  for (int round = 0; round < rounds; ++round) {
    // Sums of w l l^T and of w x l.
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    Vec3 h;
    for (std::size_t k = 0; k < lights; ++k) {
      if (!usable_[k] || k == left_out) continue;
      const double w = round == 0 ? 1 : 1 / std::max(std::abs(residual(k)), kSmallDeviation);
      const Vec3 l = l_[k], wl = w * l;
      xx += wl.x * l.x;
      xy += wl.x * l.y;
      xz += wl.x * l.z;
      yy += wl.y * l.y;
      yz += wl.y * l.z;
      zz += wl.z * l.z;
      h = h + x_[k] * wl;
    }
    const Vec3 row0 = {xx, xy, xz}, row1 = {xy, yy, yz}, row2 = {xz, yz, zz};
    const double determinant = dot(row0, cross(row1, row2)), trace = xx + yy + zz;
    if (!(determinant > kLeastDeterminant * trace * trace * trace)) return false;
    const Vec3 before = b_;
    b_ = (1 / determinant) * (h.x * cross(row1, row2) + h.y * cross(row2, row0) + h.z * cross(row0, row1));
    albedo_ = length(b_);
    if (!(albedo_ > 0)) return false;
    if (round > 0 && length(b_ - before) < kSettled * albedo_) break;
  }
  return true;
}

}  // namespace weft::solver
