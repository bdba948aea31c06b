// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/tile_system.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/statistics.h"
#include "solver/in_double/pixel.h"
#include "solver/registration/smooth_shifts.h"

namespace weft::solver {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// What no model of cloth explains better than, as a share of the albedo.
constexpr double kModelError = 0.01;
constexpr double kHuber = 1.5;
constexpr int kBlocksASide = 4;

// One shot at one point: readings over strength.
struct Row {
  Eigen::Index shot;
  Vector3d l;
  double x;
  Vector2d slope;
  double variance, slope_variance;
  double weight = 1;
};

Matrix3d information_of(const std::vector<Row>& rows) {
  Matrix3d m = Matrix3d::Zero();
  for (const Row& r : rows) m += r.weight * r.l * r.l.transpose();
  return m;
}

// Leaves out readings in attached shadow.
void drop_shadowed(std::vector<Row>& rows, std::size_t lights) {
  std::vector<double> x;
  for (const Row& r : rows) x.push_back(r.x);
  const std::size_t rank = std::min(static_cast<std::size_t>(bright_rank(lights)), x.size());
  if (rank == 0) return;
  const double least = kShadowShare * value_of_rank<double>(x, x.size() - rank);
  std::erase_if(rows, [&](const Row& r) { return r.x < least; });
}

// Weighted least squares, weights by noise and Huber's function, until they settle.
struct Fit {
  Matrix3d inverse;
  Vector3d b = Vector3d::Zero();
  bool solved = false;
};
Fit fit(std::vector<Row>& rows, const ResidualScale& scale) {
  Fit f;
  for (int pass = 0; pass < 3; ++pass) {
    const Matrix3d m = information_of(rows);
    bool regular = false;
    m.computeInverseWithCheck(f.inverse, regular);
    if (!regular) return {};
    Vector3d sum = Vector3d::Zero();
    for (const Row& r : rows) sum += r.weight * r.x * r.l;
    f.b = f.inverse * sum;
    if (pass == 2) break;
    const double model2 = kModelError * kModelError * f.b.squaredNorm();
    for (Row& r : rows) {
      const double variance = r.variance + model2;
      const double share =
          scale.chi2 > 0 ? std::abs(r.x - r.l.dot(f.b)) / (kHuber * std::sqrt(variance * scale.chi2)) : 0;
      r.weight = 1 / (variance * std::max(1.0, share));
    }
  }
  f.solved = f.b.allFinite() && f.b.squaredNorm() > 0;
  return f;
}

void add_point(const std::vector<Row>& rows, const Fit& f, Eigen::Index group, TileSystem& s,
               Eigen::VectorXd& score) {
  const double rho = f.b.norm();
  const Vector3d n = f.b / rho;
  Eigen::Matrix<double, 3, 2> slope = Eigen::Matrix<double, 3, 2>::Zero();
  Matrix3d slope_noise = Matrix3d::Zero();
  for (const Row& r : rows) {
    slope += r.weight * r.l * r.slope.transpose();
    slope_noise += r.weight * r.weight * r.slope_variance * r.l * r.l.transpose();
  }
  slope = f.inverse * slope;
  slope_noise = f.inverse * slope_noise * f.inverse;

  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& a = rows[i];
    const Vector2d ga = slope.transpose() * a.l;
    const Vector3d la = f.inverse * a.l, na = slope_noise * a.l;
    const double residual = a.x - a.l.dot(f.b);
    score.segment<2>(2 * a.shot) -= a.weight * residual * ga;
    const double variance = a.variance + kModelError * kModelError * rho * rho;
    s.chi2 += std::min(a.weight * residual * residual, residual * residual / variance);
    s.squares += a.weight * variance * residual * residual;
    const Eigen::Index first = a.shot / group * group;
    GroupInformation& known = s.groups[static_cast<std::size_t>(a.shot / group)];
    for (std::size_t j = i + 1; j-- > 0 && rows[j].shot >= first;) {
      const Row& c = rows[j];
      const double w = (i == j ? a.weight : 0) - a.weight * c.weight * la.dot(c.l);
      const Eigen::Index at = 2 * (a.shot - first), with = 2 * (c.shot - first);
      known.information.block<2, 2>(at, with) += w * ga * (slope.transpose() * c.l).transpose();
      known.noise.block<2, 2>(at, with) += w * na.dot(c.l) * Matrix2d::Identity();
    }
    const Vector3d turn = a.weight / rho * (la - n.dot(la) * n);
    s.cost[static_cast<std::size_t>(a.shot)] +=
        turn.squaredNorm() * (ga * ga.transpose() - na.dot(a.l) * Matrix2d::Identity());
  }
  s.points += 1;
  s.freedom += static_cast<double>(rows.size()) - 3;
}

}  // namespace

TileSystem tile_system(const TileInput& tile, std::span<const ClothShift::Displacement> shifts,
                       const ResidualScale& scale, std::size_t group) {
  const std::size_t shots = shifts.size();
  const auto n = static_cast<Eigen::Index>(2 * shots), of_group = static_cast<Eigen::Index>(2 * group);
  const auto planes = static_cast<std::size_t>(tile.planes);
  TileSystem s = {
      {shots / group, {Eigen::MatrixXd::Zero(of_group, of_group), Eigen::MatrixXd::Zero(of_group, of_group)}},
      std::vector<Eigen::VectorXd>(kBlocksASide * kBlocksASide, Eigen::VectorXd::Zero(n)),
      std::vector<Matrix2d>(shots, Matrix2d::Zero())};
  const PointGrid grid({tile.tile.width(), tile.tile.height()});
  std::vector<SmoothShot> smoothed;
  for (std::size_t k = 0; k < shots && grid.count() > 0; ++k) {
    smoothed.push_back(
        smooth(tile.readings[k * planes + (planes == 3)], planes == 1, tile.cfa, shifts[k], grid));
  }
  std::vector<Row> rows;
  for (int i = 0; i < grid.count(); ++i) {
    const int column = i % grid.columns, row = i / grid.columns;
    const int x = tile.tile.x0 + PointGrid::pixel(column), y = tile.tile.y0 + PointGrid::pixel(row);
    const auto at = static_cast<std::size_t>(i);
    rows.clear();
    for (std::size_t k = 0; k < shots; ++k) {
      const SmoothShot& shot = smoothed[k];
      if (!std::isfinite(shot.value[at] + shot.dx[at] + shot.dy[at])) continue;
      const LightField::Light light = tile.field->at(k, 1, x, y);
      if (!(light.strength > 0)) continue;
      const double over = 1 / light.strength;
      const double variance = tile.noise
                                  ? (tile.noise->variance(shot.value[at]) + tile.noise->shared) * over * over
                                  : scale.floor / shot.noise;
      rows.push_back({static_cast<Eigen::Index>(k),
                      Vector3d(light.direction.x, light.direction.y, light.direction.z),
                      shot.value[at] * over, Vector2d(shot.dx[at], shot.dy[at]) * over, variance * shot.noise,
                      variance * shot.slope_noise});
    }
    const std::size_t usable = rows.size();
    drop_shadowed(rows, shots);
    s.readings += static_cast<double>(usable);
    s.shadowed += static_cast<double>(usable - rows.size());
    if (rows.size() < 4) continue;
    const Fit f = fit(rows, scale);
    if (!f.solved) continue;
    const int block = row * kBlocksASide / grid.rows * kBlocksASide + column * kBlocksASide / grid.columns;
    add_point(rows, f, static_cast<Eigen::Index>(group), s, s.block_scores[static_cast<std::size_t>(block)]);
  }
  return s;
}

}  // namespace weft::solver
