// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/tile_system.h"

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

/// One shot of a tile, smoothed, as seen through a shift.
struct SmoothShot {
  std::vector<float> value, dx, dy;  ///< by point, row by row: reading, and its slope a pixel
  double noise = 0;                  ///< variance of `value` for variance 1 of a reading
  double slope_noise = 0;            ///< of `dx`, and of `dy`
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
