// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/tile_system.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/statistics.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "solver/in_double/pixel.h"
#include "solver/registration/registration.h"

namespace weft::solver {

namespace {

/// The points of a tile at which shots are compared: every second pixel both ways, far enough inside for any
/// shift that is looked for.
struct PointGrid {
  explicit PointGrid(Size tile);
  int columns = 0, rows = 0;
  int count() const { return columns * rows; }
  /// Pixel of the tile.
  static int pixel(int index);
};

constexpr double kSigma_px = 1.3;
constexpr int kReach = 5;
constexpr int kMargin = 14;  // kMostShift_px, the reach and one for the fraction, rounded to a whole cell
static_assert(kMargin >= kMostShift_px + kReach + 1 && kMargin % 2 == 0);

// A site's offset from a point, its weight and the weight's slope with respect to the point.
struct Tap {
  int offset;
  double weight, slope;
};

// Taps along one axis of a point that lies `shift` beyond a pixel, where `keep(offset)`.
template <typename Keep>
std::vector<Tap> taps(double shift, const Keep& keep) {
  std::vector<Tap> all;
  const int base = static_cast<int>(std::floor(shift));
  for (int offset = base - kReach; offset <= base + kReach + 1; ++offset) {
    if (!keep(offset)) continue;
    const double r = (offset - shift) / kSigma_px, g = std::exp(-r * r / 2);
    all.push_back({offset, g * (3 - r * r) / 2, g * r * (5 - r * r) / 2 / kSigma_px});
  }
  return all;
}

struct Sums {
  double weight = 0, slope = 0, weight2 = 0, slope2 = 0;
};
Sums sums_of(const std::vector<Tap>& all) {
  Sums s;
  for (const Tap& t : all) {
    s.weight += t.weight;
    s.slope += t.slope;
    s.weight2 += t.weight * t.weight;
    s.slope2 += t.slope * t.slope;
  }
  return s;
}

PointGrid::PointGrid(Size tile)
    : columns(std::max(0, (tile.width - 2 * kMargin + 1) / 2)),
      rows(std::max(0, (tile.height - 2 * kMargin + 1) / 2)) {}

int PointGrid::pixel(int index) {
  return kMargin + 2 * index;
}

/// The green sites of a mosaic - all sites where `mosaic` is false - weighted by a Gaussian of standard
/// deviation 1 px times (3 - r^2) / 2 along each axis: flat to fourth order where a weave has its energy, and
/// at the repeats of the greens' lattice below 0.002. A lattice of one colour alone, 2 px apart, would fold a
/// fine weave onto itself. What touches a reading that is not finite is not finite.
SmoothShot smooth(View<const float> readings, bool mosaic, const CfaPattern& cfa,
                  ClothShift::Displacement shift, const PointGrid& grid) {
  // Points lie on even pixels, so the parity of a site is that of its offset.
  const std::vector<Tap> down = taps(shift.y, [](int) { return true; });
  std::array<std::vector<Tap>, 2> across;
  std::array<Sums, 2> sums;
  for (int parity = 0; parity < 2; ++parity) {
    const auto p = static_cast<std::size_t>(parity);
    across[p] = taps(shift.x, [&](int offset) { return !mosaic || cfa.channel_at(offset & 1, parity) == 1; });
    sums[p] = sums_of(across[p]);
  }
  Sums total, slope_x, slope_y;  // of the products of both axes
  for (const Tap& t : down) {
    const Sums& s = sums[static_cast<std::size_t>(t.offset & 1)];
    total.weight += t.weight * s.weight;
    total.weight2 += t.weight * t.weight * s.weight2;
    slope_x.slope += t.weight * s.slope;
    slope_x.slope2 += t.weight * t.weight * s.slope2;
    slope_y.slope += t.slope * s.weight;
    slope_y.slope2 += t.slope * t.slope * s.weight2;
  }
  SmoothShot out;
  out.shift = shift;
  const double w = total.weight;
  out.noise = total.weight2 / (w * w);
  out.slope_noise = (slope_x.slope2 + slope_y.slope2) / 2 / (w * w);

  const auto columns = static_cast<std::size_t>(grid.columns);
  const auto pixels = static_cast<std::size_t>(readings.height());
  std::vector<float> value(columns * pixels), slope(columns * pixels);
  for (int y = 0; y < readings.height() && grid.count() > 0; ++y) {
    for (int i = 0; i < grid.columns; ++i) {
      double v = 0, d = 0;
      for (const Tap& t : across[static_cast<std::size_t>(y & 1)]) {
        const double r = readings(PointGrid::pixel(i) + t.offset, y);
        v += t.weight * r;
        d += t.slope * r;
      }
      const std::size_t at = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(i);
      value[at] = static_cast<float>(v);
      slope[at] = static_cast<float>(d);
    }
  }
  for (int j = 0; j < grid.rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      double v = 0, dx = 0, dy = 0;
      for (const Tap& t : down) {
        const std::size_t at = static_cast<std::size_t>(PointGrid::pixel(j) + t.offset) * columns + i;
        v += t.weight * value[at];
        dx += t.weight * slope[at];
        dy += t.slope * value[at];
      }
      // Divided by weights that depend on the point: the slope of a quotient.
      out.value.push_back(static_cast<float>(v / w));
      out.dx.push_back(static_cast<float>((dx - v / w * slope_x.slope) / w));
      out.dy.push_back(static_cast<float>((dy - v / w * slope_y.slope) / w));
    }
  }
  return out;
}

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// What no model of cloth explains better than, as a share of the albedo.
constexpr double kModelError = 0.01;
constexpr double kHuber = 1.5;
constexpr int kBlocksASide = 4;
// Slopes follow a shot so far: of a yarn of 4 px, which bends most, they miss 0.002 px.
constexpr double kFollowed_px = 0.05;
// Points whose products are made together.
constexpr Index kBatch = 32;

// One point: readings over strength of all shots, side by side. A shot that is left out has no weight.
struct Point {
  explicit Point(Index shots)
      : l(3, shots), slope(2, shots), x(shots), variance(shots), slope_variance(shots), weight(shots) {}

  Eigen::Matrix3Xd l;
  Eigen::Matrix2Xd slope;
  ArrayXd x, variance, slope_variance, weight;
  Index used = 0;
};

// Leaves out readings in attached shadow; `sorted` is room for them.
void drop_shadowed(Point& p, std::vector<double>& sorted) {
  sorted.clear();
  for (Index k = 0; k < p.x.size(); ++k) {
    if (p.weight[k] > 0) sorted.push_back(p.x[k]);
  }
  const auto all = static_cast<std::size_t>(p.x.size());
  const std::size_t rank = std::min(static_cast<std::size_t>(bright_rank(all)), sorted.size());
  if (rank == 0) return;
  const double least = kShadowShare * value_of_rank<double>(sorted, sorted.size() - rank);
  for (Index k = 0; k < p.x.size(); ++k) {
    if (!(p.weight[k] > 0) || !(p.x[k] < least)) continue;
    p.weight[k] = 0;
    --p.used;
  }
}

// Weighted least squares, weights by noise and Huber's function, until they settle.
struct Fit {
  Matrix3d inverse;
  Vector3d b = Vector3d::Zero();
  bool solved = false;
};
Fit fit(Point& p, const ResidualScale& scale) {
  Fit f;
  for (int pass = 0; pass < 3; ++pass) {
    Matrix3d m = Matrix3d::Zero();
    Vector3d sum = Vector3d::Zero();
    for (Index k = 0; k < p.x.size(); ++k) {
      const Vector3d wl = p.weight[k] * p.l.col(k);
      m += wl * p.l.col(k).transpose();
      sum += p.x[k] * wl;
    }
    bool regular = false;
    m.computeInverseWithCheck(f.inverse, regular);
    if (!regular) return {};
    f.b = f.inverse * sum;
    if (pass == 2) break;
    const double model2 = kModelError * kModelError * f.b.squaredNorm();
    for (Index k = 0; k < p.x.size(); ++k) {
      if (!(p.weight[k] > 0)) continue;
      const double variance = p.variance[k] + model2;
      const double share = scale.chi2 > 0 ? std::abs(p.x[k] - p.l.col(k).dot(f.b)) /
                                                (kHuber * std::sqrt(variance * scale.chi2))
                                          : 0;
      p.weight[k] = 1 / (variance * std::max(1.0, share));
    }
  }
  f.solved = f.b.allFinite() && f.b.squaredNorm() > 0;
  return f;
}

// Sums the equations of points. The part of a pair of shots is of rank 3 in their displacements, and that of
// their noise of rank 9 in the shots: both are products of factors of many points.
class PointSums {
 public:
  PointSums(Index shots, Index group, TileSystem& s)
      : group_(group), s_(s), shared_(2 * shots, 3 * kBatch), noise_(shots, 9 * kBatch) {}

  void add(const Point& p, const Fit& f, VectorXd& score) {
    const double rho = f.b.norm();
    const Vector3d n = f.b / rho;
    Eigen::Matrix<double, 3, 2> slope = Eigen::Matrix<double, 3, 2>::Zero();
    Matrix3d slope_noise = Matrix3d::Zero();
    for (Index k = 0; k < p.x.size(); ++k) {
      const Vector3d wl = p.weight[k] * p.l.col(k);
      slope += wl * p.slope.col(k).transpose();
      slope_noise += p.slope_variance[k] * wl * wl.transpose();
    }
    slope = f.inverse * slope;
    slope_noise = f.inverse * slope_noise * f.inverse;
    const Matrix3d root = f.inverse.llt().matrixL(), noise_root = root_of(slope_noise);

    for (Index k = 0; k < p.x.size(); ++k) {
      const double w = p.weight[k];
      const Vector3d l = p.l.col(k), u = w * (root.transpose() * l), d = noise_root.transpose() * l;
      const Vector2d g = slope.transpose() * l;
      for (Index i = 0; i < 3; ++i) {
        shared_.block<2, 1>(2 * k, 3 * batch_ + i) = u[i] * g;
        for (Index j = 0; j < 3; ++j) noise_(k, 9 * batch_ + 3 * i + j) = u[i] * d[j];
      }
      if (!(w > 0)) continue;
      const double residual = p.x[k] - l.dot(f.b), noise = d.squaredNorm();
      const double variance = p.variance[k] + kModelError * kModelError * rho * rho;
      const Matrix2d gg = g * g.transpose();
      score.segment<2>(2 * k) -= w * residual * g;
      s_.chi2 += std::min(w * residual * residual, residual * residual / variance);
      s_.squares += w * variance * residual * residual;
      GroupInformation& known = s_.groups[static_cast<std::size_t>(k / group_)];
      const Index at = k % group_;
      known.information.block<2, 2>(2 * at, 2 * at) += w * gg;
      known.noise(at, at) += w * noise;
      const Vector3d la = f.inverse * l, turn = w / rho * (la - n.dot(la) * n);
      s_.cost[static_cast<std::size_t>(k)] += turn.squaredNorm() * (gg - noise * Matrix2d::Identity());
    }
    s_.points += 1;
    s_.freedom += static_cast<double>(p.used) - 3;
    if (++batch_ == kBatch) flush();
  }

  void flush() {
    for (std::size_t g = 0; g < s_.groups.size() && batch_ > 0; ++g) {
      const Index first = static_cast<Index>(g) * group_;
      s_.groups[g].information.selfadjointView<Eigen::Lower>().rankUpdate(
          shared_.block(2 * first, 0, 2 * group_, 3 * batch_), -1);
      s_.groups[g].noise.selfadjointView<Eigen::Lower>().rankUpdate(
          noise_.block(first, 0, group_, 9 * batch_), -1);
    }
    batch_ = 0;
  }

 private:
  // R R^T of a matrix that has no negative direction, but may have one of zero.
  static Matrix3d root_of(const Matrix3d& m) {
    const double little = 1e-12 * m.trace() + 1e-300;
    return (m + little * Matrix3d::Identity()).llt().matrixL();
  }

  Index group_;
  TileSystem& s_;
  MatrixXd shared_, noise_;  // columns of the batch
  Index batch_ = 0;
};

}  // namespace

void TileShots::read_lights(std::size_t shots) {
  const PointGrid grid({tile_.tile.width(), tile_.tile.height()});
  for (int i = 0; i < grid.count(); ++i) {
    const int x = tile_.tile.x0 + PointGrid::pixel(i % grid.columns),
              y = tile_.tile.y0 + PointGrid::pixel(i / grid.columns);
    for (std::size_t k = 0; k < shots; ++k) {
      const LightField::Light light = tile_.field->at(k, 1, x, y);
      const double over = light.strength > 0 ? 1 / light.strength : 0;
      lights_.push_back({static_cast<float>(light.direction.x), static_cast<float>(light.direction.y),
                         static_cast<float>(light.direction.z), static_cast<float>(over)});
    }
  }
}

TileSystem TileShots::system_at(std::span<const ClothShift::Displacement> shifts, const ResidualScale& scale,
                                std::size_t group) {
  const std::size_t shots = shifts.size();
  const auto n = static_cast<Index>(shots), of_group = static_cast<Index>(group);
  const auto planes = static_cast<std::size_t>(tile_.planes);
  TileSystem s = {
      {shots / group, {MatrixXd::Zero(2 * of_group, 2 * of_group), MatrixXd::Zero(of_group, of_group)}},
      std::vector<VectorXd>(kBlocksASide * kBlocksASide, VectorXd::Zero(2 * n)),
      std::vector<Matrix2d>(shots, Matrix2d::Zero())};
  const PointGrid grid({tile_.tile.width(), tile_.tile.height()});
  if (grid.count() == 0) return s;
  if (lights_.empty()) read_lights(shots);
  std::vector<ClothShift::Displacement> beyond(shots);  // what the slopes follow
  smoothed_.resize(shots);
  for (std::size_t k = 0; k < shots; ++k) {
    SmoothShot& shot = smoothed_[k];
    beyond[k] = {shifts[k].x - shot.shift.x, shifts[k].y - shot.shift.y};
    if (!shot.value.empty() && std::hypot(beyond[k].x, beyond[k].y) <= kFollowed_px) continue;
    shot = smooth(tile_.readings[k * planes + (planes == 3)], planes == 1, tile_.cfa, shifts[k], grid);
    beyond[k] = {};
  }
  Point p(n);
  PointSums sums(n, of_group, s);
  std::vector<double> sorted;
  for (int i = 0; i < grid.count(); ++i) {
    const int column = i % grid.columns, row = i / grid.columns;
    const auto at = static_cast<std::size_t>(i);
    p.used = 0;
    for (Index k = 0; k < n; ++k) {
      const auto of = static_cast<std::size_t>(k);
      const SmoothShot& shot = smoothed_[of];
      const Light& light = lights_[at * shots + of];
      const double value = shot.value[at] + beyond[of].x * shot.dx[at] + beyond[of].y * shot.dy[at];
      const double over = light.over;
      const bool is_usable = std::isfinite(shot.value[at] + shot.dx[at] + shot.dy[at]) && over > 0;
      p.weight[k] = is_usable ? 1 : 0;
      p.l.col(k) = Vector3d(light.x, light.y, light.z);
      p.x[k] = is_usable ? value * over : 0;
      p.slope.col(k) = is_usable ? Vector2d(Vector2d(shot.dx[at], shot.dy[at]) * over) : Vector2d(0, 0);
      const double variance = !is_usable ? 0
                              : tile_.noise
                                  ? (tile_.noise->variance(value) + tile_.noise->shared) * over * over
                                  : scale.floor / shot.noise;
      p.variance[k] = variance * shot.noise;
      p.slope_variance[k] = variance * shot.slope_noise;
      p.used += is_usable ? 1 : 0;
    }
    const Index usable = p.used;
    drop_shadowed(p, sorted);
    s.readings += static_cast<double>(usable);
    s.shadowed += static_cast<double>(usable - p.used);
    if (p.used < 4) continue;
    const Fit f = fit(p, scale);
    if (!f.solved) continue;
    const int block = row * kBlocksASide / grid.rows * kBlocksASide + column * kBlocksASide / grid.columns;
    sums.add(p, f, s.block_scores[static_cast<std::size_t>(block)]);
  }
  sums.flush();
  return s;
}

}  // namespace weft::solver
