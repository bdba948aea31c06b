// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <span>

#include "core/base/vec.h"
#include "solver/in_double/pixel.h"
#include "solver/method.h"

namespace weft::torture {

/// The system of a pixel as a textbook writes it: rows e l and r, every reading as it is, no scaling.
template <typename Scalar>
struct PlainSystem {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  Matrix a;
  Vector r;

  PlainSystem(std::span<const solver::PixelRow> rows, std::size_t plane)
      : a(static_cast<Eigen::Index>(rows.size()), 3), r(static_cast<Eigen::Index>(rows.size())) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const Vec3 l = rows[k].direction;
      const auto e = static_cast<Scalar>(rows[k].strength[plane]);
      a.row(i) << e * static_cast<Scalar>(l.x), e * static_cast<Scalar>(l.y), e * static_cast<Scalar>(l.z);
      r[i] = static_cast<Scalar>(rows[k].reading[plane]);
    }
  }
};

/// Unit length, or nothing where the solution is no number.
template <typename Vector>
std::optional<Vec3> direction_of(const Vector& b) {
  const Vec3 v = {static_cast<double>(b[0]), static_cast<double>(b[1]), static_cast<double>(b[2])};
  const double rho = length(v);
  if (!(rho > 0) || !std::isfinite(rho)) return std::nullopt;
  return normalized(v);
}

/// (A^T A)^-1 A^T r.
template <typename Scalar>
std::optional<Vec3> plain_normal(std::span<const solver::PixelRow> rows) {
  const PlainSystem<Scalar> s(rows, 0);
  const Eigen::Matrix<Scalar, 3, 3> g = s.a.transpose() * s.a;
  return direction_of(Eigen::Matrix<Scalar, 3, 1>(g.inverse() * (s.a.transpose() * s.r)));
}

template <typename Scalar>
std::optional<Vec3> qr_normal(std::span<const solver::PixelRow> rows) {
  const PlainSystem<Scalar> s(rows, 0);
  return direction_of(typename PlainSystem<Scalar>::Vector(s.a.householderQr().solve(s.r)));
}

template <typename Scalar>
std::optional<Vec3> svd_normal(std::span<const solver::PixelRow> rows) {
  const PlainSystem<Scalar> s(rows, 0);
  const Eigen::JacobiSVD<typename PlainSystem<Scalar>::Matrix> svd(s.a,
                                                                   Eigen::ComputeThinU | Eigen::ComputeThinV);
  return direction_of(typename PlainSystem<Scalar>::Vector(svd.solve(s.r)));
}

}  // namespace weft::torture
