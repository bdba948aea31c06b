// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/lateral_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr std::size_t kLeastShared = 40;  // edges
constexpr double kLeastSigmas = 3;        // of a cubic term
// Chi-square that one or two terms of noise exceed once in a thousand.
constexpr std::array<double, 2> kMostByNoise = {10.83, 13.82};
constexpr double kMostSigmas = 4;          // of an edge that counts
constexpr double kLeast_px = 0.05;         // that helps a map
constexpr double kSigmaOfMedian = 1.4826;  // standard deviation over the median of the absolute values

// How far apart two colours show an edge, and how far apart each term alone, at 1, would put them.
struct Apart {
  double by_px;
  Eigen::Vector2d terms_px;
};

// Scale and, if it was fitted, cubic term.
struct LateralTerms {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  int count = 0;  // terms fitted

  double sigma(int i) const { return std::sqrt(covariance(i, i)); }
  bool is_noise() const {
    const auto solver = covariance.topLeftCorner(count, count).ldlt();
    return value.head(count).dot(solver.solve(value.head(count))) <
           kMostByNoise[static_cast<std::size_t>(count - 1)];
  }
};

// A photosite that looks farther out shows an edge farther in.
std::vector<Apart> apart(std::span<const BoardEdge> edges, const CameraModel& camera, std::size_t colour) {
  std::vector<Apart> all;
  for (const BoardEdge& edge : edges) {
    if (!edge.seen[1] || !edge.seen[colour]) continue;
    const auto across = [&](const RadialShift& shift) {
      const auto [dx, dy] = shift_at(shift, camera, edge.middle.x, edge.middle.y);
      return dx * edge.across.x + dy * edge.across.y;
    };
    all.push_back(
        {edge.seen[1]->at_px - edge.seen[colour]->at_px, {across({.scale = 1}), across({.cubic = 1})}});
  }
  return all;
}

// By the first `count` terms.
LateralTerms fit_terms(const std::vector<Apart>& edges, int count) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Apart& edge : edges) {
    normal += edge.terms_px * edge.terms_px.transpose();
    right += edge.by_px * edge.terms_px;
  }
  LateralTerms terms;
  terms.count = count;
  const auto solver = normal.topLeftCorner(count, count).ldlt();
  terms.value.head(count) = solver.solve(right.head(count));
  double squares = 0;
  for (const Apart& edge : edges) squares += std::pow(edge.by_px - edge.terms_px.dot(terms.value), 2);
  terms.covariance.topLeftCorner(count, count) = squares / (static_cast<double>(edges.size()) - count) *
                                                 solver.solve(Eigen::MatrixXd::Identity(count, count));
  return terms;
}

// Without the edges that are unlike the others.
std::vector<Apart> alike(std::vector<Apart> edges) {
  const LateralTerms terms = fit_terms(edges, 2);
  const auto off_px = [&](const Apart& edge) {
    return std::abs(edge.by_px - edge.terms_px.dot(terms.value));
  };
  std::vector<double> all;
  for (const Apart& edge : edges) all.push_back(off_px(edge));
  const double most_px = kMostSigmas * kSigmaOfMedian * median(std::move(all));
  std::erase_if(edges, [&](const Apart& edge) { return off_px(edge) > most_px; });
  return edges;
}

// The largest shift between axis and corner, of what each term makes of it in the corner.
double farthest_px(const Eigen::Vector2d& corner_px) {
  double most = 0;
  for (int i = 1; i <= 10; ++i) {
    const double share = 0.1 * i;
    most = std::max(most, std::abs(share * (corner_px[0] + share * share * corner_px[1])));
  }
  return most;
}

}  // namespace

std::optional<LateralFit> fit_lateral_color(std::span<const BoardEdge> edges, const CameraModel& camera) {
  LateralFit fit;
  LateralColor color;
  for (const std::size_t i : {0U, 1U}) {
    std::vector<Apart> all = apart(edges, camera, 2 * i);
    if (all.size() < kLeastShared) return {};
    all = alike(std::move(all));
    LateralTerms terms = fit_terms(all, 2);
    if (std::abs(terms.value[1]) < kLeastSigmas * terms.sigma(1)) terms = fit_terms(all, 1);
    const Eigen::Vector2d of_corner = {shift_at_corner({.scale = 1}, camera),
                                       shift_at_corner({.cubic = 1}, camera)};
    fit.sigma_corner_px[i] = std::sqrt(of_corner.dot(terms.covariance * of_corner));
    if (terms.is_noise() || farthest_px(terms.value.cwiseProduct(of_corner)) < kLeast_px) continue;
    fit.corner_px[i] = of_corner.dot(terms.value);
    (i == 0 ? color.red : color.blue) = {terms.value[0], terms.value[1], terms.sigma(0), terms.sigma(1)};
    fit.color = color;
  }
  return fit;
}

}  // namespace weft::calibration
