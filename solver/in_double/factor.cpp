// SPDX-License-Identifier: Apache-2.0
#include "solver/in_double/factor.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "core/rig/light_field.h"

namespace weft::solver {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixX3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Rows sqrt(w) l and sqrt(w) x, for the factorisations that do not square the condition number.
void write_rows(std::span<const WeightedDirection> rows, MatrixX3d& a, VectorXd& x) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  a.resize(count, 3);
  x.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const WeightedDirection& row = rows[static_cast<std::size_t>(i)];
    a.row(i) = std::sqrt(row.w) * row.l.transpose();
    x[i] = std::sqrt(row.w) * row.x;
  }
}

void solve_by_qr(const MatrixX3d& a, const VectorXd& x, Factor& f) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  const Matrix3d r = qr.matrixQR().topRows<3>().triangularView<Eigen::Upper>();
  const Matrix3d r_inverse = r.triangularView<Eigen::Upper>().solve(Matrix3d::Identity());
  f.inverse = r_inverse * r_inverse.transpose();
  f.b = qr.solve(x);
  f.path = EquationsSolvedBy::kQr;
}

void solve_by_svd(const Eigen::JacobiSVD<Eigen::MatrixXd>& svd, const VectorXd& x, Factor& f) {
  const Vector3d inverse_sigma = svd.singularValues().cwiseInverse();
  const Matrix3d v = svd.matrixV();
  f.b = v * inverse_sigma.cwiseProduct(Vector3d(svd.matrixU().transpose() * x));
  f.inverse = v * inverse_sigma.cwiseAbs2().asDiagonal() * v.transpose();
  f.path = EquationsSolvedBy::kSvd;
}

}  // namespace

Factor factorise(std::span<const WeightedDirection> rows) {
  Factor f;
  f.condition = std::numeric_limits<double>::infinity();
  if (rows.size() < 3) return f;
  Matrix3d g = Matrix3d::Zero();
  Vector3d rhs = Vector3d::Zero();
  for (const WeightedDirection& row : rows) {
    g.noalias() += row.w * row.l * row.l.transpose();
    rhs.noalias() += row.w * row.x * row.l;
  }
  const Matrix3d inverse = g.inverse();
  // |G|_F |G^-1|_F bounds the square of the condition number from above, and is at most three times it.
  const double condition = std::sqrt(g.norm() * inverse.norm());
  if (condition < kDoubleCondition) {
    f.condition = condition;
    f.inverse = inverse;
    f.b = inverse * rhs;
    f.path = EquationsSolvedBy::kNormalEquations;
    return f;
  }

  MatrixX3d a;
  VectorXd x;
  write_rows(rows, a, x);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Vector3d& sigma = svd.singularValues();
  constexpr double kRankless = 1e-13;
  if (!(sigma[2] > kRankless * sigma[0])) return f;
  f.condition = sigma[0] / sigma[2];
  if (f.condition < kIllConditionedFrom) {
    solve_by_qr(a, x, f);
  } else {
    solve_by_svd(svd, x, f);
  }
  return f;
}

}  // namespace weft::solver
