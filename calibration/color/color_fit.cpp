// SPDX-License-Identifier: Apache-2.0
#include "calibration/color/color_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/base/statistics.h"
#include "core/rig/color_transform.h"

namespace weft::calibration {
namespace {

constexpr int kRounds = 30;
constexpr double kStep = 1e-5;    // of a parameter, for derivatives
constexpr double kMetric = 0.05;  // Lab units, for the metric
constexpr std::size_t kFewest = 9;
constexpr double kLeastSpread = 0.02;                       // of colours about grey, over their brightness
constexpr double kFarOff = 12, kNear = 3, kNarrower = 1.2;  // CIEDE2000

// Entries off the diagonal by rows, then log scale, then shading: u, v, u^2, u v, v^2.
constexpr Eigen::Index kScale = 6, kShade = 7, kSlopes = 2, kShades = 5;

Eigen::Vector3d lab_vector(const Lab& lab) {
  return {lab.L, lab.a, lab.b};
}

Lab lab_at(const Lab& lab, const Eigen::Vector3d& off) {
  return {lab.L + off[0], lab.a + off[1], lab.b + off[2]};
}

// Root of the metric tensor of CIEDE2000: |root * d| is the distance of colours that differ by a small d.
Eigen::Matrix3d metric_root(const Lab& at) {
  const auto square = [&](const Eigen::Vector3d& d) {
    const double plus = ciede2000(at, lab_at(at, d)), minus = ciede2000(at, lab_at(at, -d));
    return (plus * plus + minus * minus) / 2;
  };
  Eigen::Matrix3d metric;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      const Eigen::Vector3d x = kMetric * Eigen::Vector3d::Unit(i), y = kMetric * Eigen::Vector3d::Unit(j);
      metric(i, j) = metric(j, i) = (square(x + y) - square(x - y)) / (4 * kMetric * kMetric);
    }
  }
  return metric.llt().matrixU();
}

Mat3 matrix_of(const Eigen::VectorXd& p) {
  return {{{1 - p[0] - p[1], p[0], p[1]}, {p[2], 1 - p[2] - p[3], p[3]}, {p[4], p[5], 1 - p[4] - p[5]}}};
}

Rgb times(const Mat3& m, const Rgb& rgb, double scale) {
  const Vec3 r = m * Vec3{rgb[0], rgb[1], rgb[2]};
  return {scale * r.x, scale * r.y, scale * r.z};
}

double log_light(const ChartSample& s, const Eigen::VectorXd& p) {
  if (p.size() <= kShade) return 0;
  const double plane = p[kShade] * s.u + p[kShade + 1] * s.v;
  if (p.size() == kShade + kSlopes) return plane;
  return plane + p[kShade + 2] * s.u * s.u + p[kShade + 3] * s.u * s.v + p[kShade + 4] * s.v * s.v;
}

Rgb predicted(const ChartSample& s, const Eigen::VectorXd& p) {
  return times(matrix_of(p), s.camera, std::exp(p[kScale] - log_light(s, p)));
}

// Samples with what the fit needs of each.
struct Target {
  ChartSample sample;
  Eigen::Matrix3d root;
  Eigen::Vector3d lab;
  double weight = 1;  // 0 leaves it out
};

std::vector<Target> targets_of(std::span<const ChartSample> samples) {
  std::vector<Target> targets;
  for (const ChartSample& s : samples) {
    const Lab lab = lab_of_rec709(s.reference);
    targets.push_back({s, metric_root(lab), lab_vector(lab), 1});
  }
  return targets;
}

Eigen::VectorXd residuals(const std::vector<Target>& targets, const Eigen::VectorXd& p) {
  Eigen::VectorXd r(3 * static_cast<Eigen::Index>(targets.size()));
  Eigen::Index i = 0;
  for (const Target& t : targets) {
    const Eigen::Vector3d lab = lab_vector(lab_of_rec709(predicted(t.sample, p)));
    r.segment<3>(i) = std::sqrt(t.weight) * (t.root * (lab - t.lab));
    i += 3;
  }
  return r;
}

struct Solution {
  Eigen::VectorXd parameters;
  Eigen::MatrixXd normal;  // J^T J
  double square = 0;       // of the residuals
};

// Levenberg-Marquardt; derivatives by central differences.
Solution solved(const std::vector<Target>& targets, Eigen::VectorXd p, Eigen::Index first_free = 0) {
  const Eigen::Index n = p.size();
  Eigen::VectorXd r = residuals(targets, p);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  double damping = 1e-4;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(r.size(), n);
    for (Eigen::Index k = first_free; k < n; ++k) {
      Eigen::VectorXd plus = p, minus = p;
      plus[k] += kStep;
      minus[k] -= kStep;
      J.col(k) = (residuals(targets, plus) - residuals(targets, minus)) / (2 * kStep);
    }
    normal = J.transpose() * J;
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().head(first_free).setOnes();
    const Eigen::VectorXd tried = p - damped.ldlt().solve(J.transpose() * r);
    const Eigen::VectorXd tried_r = residuals(targets, tried);
    if (!(tried_r.squaredNorm() < r.squaredNorm())) {
      damping *= 10;
      if (damping > 1e6) break;
      continue;
    }
    const bool is_still = r.squaredNorm() - tried_r.squaredNorm() < 1e-12 * r.squaredNorm();
    p = tried;
    r = tried_r;
    damping /= 10;
    if (is_still) break;
  }
  return {p, normal, r.squaredNorm()};
}

// The scale that makes luminances of camera and reference alike, and nothing else.
Eigen::VectorXd start(std::span<const ChartSample> samples, ChartLight light) {
  double camera = 0, reference = 0;
  for (const ChartSample& s : samples) {
    camera += s.camera[1];
    reference += s.reference[1];
  }
  const Eigen::Index shades = light == ChartLight::kEven     ? 0
                              : light == ChartLight::kSloped ? kSlopes
                                                             : kShades;
  Eigen::VectorXd p = Eigen::VectorXd::Zero(kShade + shades);
  p[kScale] = std::log(reference / camera);
  return p;
}

double off(const ChartSample& s, const Eigen::VectorXd& p) {
  return ciede2000_of(predicted(s, p), s.reference);
}

// In units of `scale`, and what it counts: 1 at most (Geman and McClure 1985).
double outlying(const Target& t, const Eigen::VectorXd& p, double scale) {
  const double e = off(t.sample, p) / scale;
  return e * e / (1 + e * e);
}

double cost(const std::vector<Target>& targets, const Eigen::VectorXd& p) {
  double sum = 0;
  for (const Target& t : targets) sum += outlying(t, p, kNear);
  return sum;
}

// From `p` on, with ever less weight for what is far off.
Eigen::VectorXd robust(std::vector<Target> targets, Eigen::VectorXd p, double first_scale) {
  for (double scale = first_scale; scale >= kNear; scale /= kNarrower) {
    for (Target& t : targets) t.weight = std::pow(1 - outlying(t, p, scale), 2);
    p = solved(targets, p).parameters;
  }
  return p;
}

// Luminance, reference over camera.
double median_ratio(std::span<const ChartSample> samples) {
  std::vector<double> ratios;
  for (const ChartSample& s : samples) {
    ratios.push_back(xyz_of_rec709(s.reference)[1] / std::max(xyz_of_rec709(s.camera)[1], 1e-9));
  }
  return median(std::move(ratios));
}

Result<void> check(std::span<const ChartSample> samples) {
  double brightest = 0;
  for (const ChartSample& s : samples) brightest = std::max(brightest, s.camera[1]);
  if (samples.size() >= kFewest && brightest > 0) return {};
  return Error{ErrorKind::kBadData, "too few patches for a colour matrix", "chart",
               fmt::format("{} can be used, {} are needed", brightest > 0 ? samples.size() : 0, kFewest),
               "photograph the chart without highlights, shadows and full patches"};
}

// How far colours are from grey in the direction in which they are nearest to it, rms over brightness. A
// matrix that leaves grey as it is rests on these alone; of greys they are noise, and fit anything.
double spread_of(std::span<const ChartSample> samples) {
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double brightness = 0;
  for (const ChartSample& s : samples) {
    const auto& [r, g, b] = s.camera;
    const Eigen::Vector2d from_grey((r - g) / std::sqrt(2.0), (r + g - 2 * b) / std::sqrt(6.0));
    squares += from_grey * from_grey.transpose();
    brightness += (r * r + g * g + b * b) / 3;
  }
  // The smaller of its eigenvalues.
  const double half = (squares(0, 0) + squares(1, 1)) / 2;
  const double aside = std::hypot((squares(0, 0) - squares(1, 1)) / 2, squares(0, 1));
  return std::sqrt(std::max(0.0, half - aside) / brightness);
}

// Covariance of the nine entries from that of the six free ones.
std::vector<double> covariance_of_entries(const Eigen::MatrixXd& of_parameters) {
  Eigen::Matrix<double, 9, 6> entries = Eigen::Matrix<double, 9, 6>::Zero();
  for (int row = 0; row < 3; ++row) {
    int k = 2 * row;
    for (int column = 0; column < 3; ++column) {
      if (column == row) continue;
      entries(3 * row + column, k) = 1;
      entries(3 * row + row, k) = -1;
      ++k;
    }
  }
  const Eigen::Matrix<double, 9, 9> c = entries * of_parameters.topLeftCorner<6, 6>() * entries.transpose();
  std::vector<double> covariance;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) covariance.push_back((c(i, j) + c(j, i)) / 2);
  }
  return covariance;
}

Eigen::Vector4d with_one(const Xyy& c) {
  return {c[0], c[1], c[2], 1};
}

// Least squares of X A = Y (seed 004): by the normal equations, with a ridge that only tells in a case that
// has no answer.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& X, const Eigen::MatrixXd& Y) {
  Eigen::MatrixXd normal = X.transpose() * X;
  normal.diagonal().array() += 1e-12 * normal.trace();
  return normal.ldlt().solve(X.transpose() * Y);
}

std::array<double, 12> fit_affine(const std::vector<Xyy>& from, const std::vector<Xyy>& to) {
  const auto n = static_cast<Eigen::Index>(from.size());
  Eigen::MatrixXd X(n, 4), Y(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    X.row(i) = with_one(from[static_cast<std::size_t>(i)]).transpose();
    for (Eigen::Index c = 0; c < 3; ++c)
      Y(i, c) = to[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)];
  }
  const Eigen::MatrixXd A = least_squares(X, Y);
  std::array<double, 12> m = {};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 4; ++k)
      m[4 * c + k] = A(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c));
  }
  return m;
}

std::array<double, 12> fit_cubic(const std::vector<Xyy>& from, const std::vector<Xyy>& to) {
  const auto n = static_cast<Eigen::Index>(from.size());
  std::array<double, 12> m = {};
  for (std::size_t c = 0; c < 3; ++c) {
    Eigen::MatrixXd X(n, 4), Y(n, 1);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double t = from[static_cast<std::size_t>(i)][c];
      X.row(i) << 1, t, t * t, t * t * t;
      Y(i, 0) = to[static_cast<std::size_t>(i)][c];
    }
    const Eigen::MatrixXd A = least_squares(X, Y);
    for (std::size_t k = 0; k < 4; ++k) m[4 * c + k] = A(static_cast<Eigen::Index>(k), 0);
  }
  return m;
}

}  // namespace

double ciede2000_of(const Rgb& first, const Rgb& second) {
  return ciede2000(lab_of_rec709(first), lab_of_rec709(second));
}

Result<ColorFit> fit_color(std::span<const ChartSample> samples, ChartLight light, bool leave_one_out) {
  if (Result<void> ok = check(samples); !ok) return std::move(ok).error();
  std::vector<Target> targets = targets_of(samples);
  const Solution fit = solved(targets, start(samples, light));
  const Eigen::LDLT<Eigen::MatrixXd> factored(fit.normal);
  const Eigen::Index n = fit.parameters.size();
  const double freedom = 3 * static_cast<double>(samples.size()) - static_cast<double>(n);
  if (!(spread_of(samples) > kLeastSpread) || !factored.isPositive() || !(factored.rcond() > 1e-12) ||
      !fit.parameters.allFinite()) {
    return Error{ErrorKind::kBadData, "the patches do not determine a colour matrix", "chart",
                 "their colours are too much alike", "use all patches of the chart"};
  }
  const Eigen::MatrixXd covariance =
      factored.solve(Eigen::MatrixXd::Identity(n, n)) * (fit.square / std::max(freedom, 1.0));

  ColorFit result;
  result.rec709_from_camera = matrix_of(fit.parameters);
  result.covariance = covariance_of_entries(covariance);
  result.scale = std::exp(fit.parameters[kScale]);
  // Without matrix: only what follows the six entries is free.
  const Eigen::VectorXd without = solved(targets, start(samples, light), kScale).parameters;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    result.light.push_back(std::exp(log_light(samples[i], fit.parameters)));
    result.off.push_back(off(samples[i], fit.parameters));
    result.before.push_back(off(samples[i], without));
    if (!leave_one_out) continue;
    targets[i].weight = 0;
    result.left_out.push_back(off(samples[i], solved(targets, fit.parameters).parameters));
    targets[i].weight = 1;
  }
  return result;
}

Result<std::vector<double>> light_of_each(std::span<const ChartSample> samples) {
  if (Result<void> ok = check(samples); !ok) return std::move(ok).error();
  const std::vector<Target> targets = targets_of(samples);
  Eigen::VectorXd even = start(samples, ChartLight::kEven);
  even[kScale] = std::log(median_ratio(samples));
  Eigen::VectorXd sloped = start(samples, ChartLight::kSloped), from_even = sloped;
  sloped[kScale] = even[kScale];
  even = robust(targets, even, kFarOff);
  from_even.head(kShade) = even;
  sloped = robust(targets, sloped, kFarOff);
  from_even = robust(targets, from_even, kFarOff / 2);
  const Eigen::VectorXd& p = cost(targets, from_even) < cost(targets, sloped) ? from_even : sloped;
  std::vector<double> shares;
  for (const ChartSample& s : samples) {
    shares.push_back(xyz_of_rec709(predicted(s, p))[1] / xyz_of_rec709(s.reference)[1]);
  }
  return shares;
}

Result<ColorCurve> fit_color_curve(std::span<const ChartSample> samples, double scale) {
  if (Result<void> ok = check(samples); !ok) return std::move(ok).error();
  std::vector<Xyy> from, to;
  for (const ChartSample& s : samples) {
    from.push_back(
        xyy_of_xyz(xyz_of_rec709({scale * s.camera[0], scale * s.camera[1], scale * s.camera[2]})));
    to.push_back(xyy_of_xyz(xyz_of_rec709(s.reference)));
  }
  ColorCurve curve;
  curve.before = fit_affine(from, to);
  for (Xyy& c : from) c = affine_of(curve.before, c);
  curve.cubic = fit_cubic(from, to);
  for (Xyy& c : from) c = cubic_of(curve.cubic, c);
  curve.after = fit_affine(from, to);
  return curve;
}

}  // namespace weft::calibration
