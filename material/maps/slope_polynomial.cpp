// SPDX-License-Identifier: Apache-2.0
#include "material/maps/slope_polynomial.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>

namespace weft::material {

SlopePolynomial::SlopePolynomial(Size size, int degree)
    : right(static_cast<std::size_t>(terms(degree))),
      up(static_cast<std::size_t>(terms(degree))),
      size_(size),
      degree_(degree) {}

// By Bonnet's recursion.
SlopePolynomial::Axis SlopePolynomial::axis_at(double place, int length) {
  const double u = (2 * place + 1) / length - 1;
  Axis values = {1, u};
  for (std::size_t n = 1; n + 1 < values.size(); ++n) {
    const auto k = static_cast<double>(n);
    values[n + 1] = ((2 * k + 1) * u * values[n] - k * values[n - 1]) / (k + 1);
  }
  return values;
}

void SlopePolynomial::read(int y, float* to_right, float* to_up) const {
  const Axis of_row = at_row(y);
  Axis in_x_right = {}, in_x_up = {};
  for_each_term(degree_, [&](std::size_t term, std::size_t i, std::size_t j) {
    in_x_right[i] += right[term] * of_row[j];
    in_x_up[i] += up[term] * of_row[j];
  });
  for (int x = 0; x < size_.width; ++x) {
    const Axis of_column = at_column(x);
    double sum_right = 0, sum_up = 0;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree_); ++i) {
      sum_right += in_x_right[i] * of_column[i];
      sum_up += in_x_up[i] * of_column[i];
    }
    to_right[x] = static_cast<float>(sum_right);
    to_up[x] = static_cast<float>(sum_up);
  }
}

SlopeFit::SlopeFit(int degree)
    : degree_(degree),
      terms_(static_cast<std::size_t>(SlopePolynomial::terms(degree))),
      matrix_(terms_ * terms_),
      right_(terms_),
      up_(terms_) {}

void SlopeFit::add(const std::vector<double>& values, double weight, double right, double up) {
  for (std::size_t a = 0; a < terms_; ++a) {
    for (std::size_t b = 0; b < terms_; ++b) matrix_[a * terms_ + b] += weight * values[a] * values[b];
    right_[a] += weight * values[a] * right;
    up_[a] += weight * values[a] * up;
  }
}

void SlopeFit::add_row(const RowMoments& row, const SlopePolynomial::Axis& y, double weight) {
  SlopePolynomial::for_each_term(degree_, [&](std::size_t a, std::size_t ai, std::size_t aj) {
    SlopePolynomial::for_each_term(degree_, [&](std::size_t b, std::size_t bi, std::size_t bj) {
      matrix_[a * terms_ + b] += weight * row.products[ai][bi] * y[aj] * y[bj];
    });
    right_[a] += weight * row.right[ai] * y[aj];
    up_[a] += weight * row.up[ai] * y[aj];
  });
}

void SlopeFit::add(const SlopeFit& other) {
  for (std::size_t i = 0; i < matrix_.size(); ++i) matrix_[i] += other.matrix_[i];
  for (std::size_t i = 0; i < terms_; ++i) {
    right_[i] += other.right_[i];
    up_[i] += other.up_[i];
  }
}

bool SlopeFit::solve(SlopePolynomial& polynomial) const {
  constexpr double kLeastPivot = 1e-9;  // of the largest
  const auto n = static_cast<Eigen::Index>(terms_);
  const Eigen::LDLT<Eigen::MatrixXd> factors(Eigen::Map<const Eigen::MatrixXd>(matrix_.data(), n, n));
  const Eigen::VectorXd pivots = factors.vectorD();
  if (!(pivots.minCoeff() > kLeastPivot * pivots.maxCoeff())) return false;
  Eigen::Map<Eigen::VectorXd>(polynomial.right.data(), n) =
      factors.solve(Eigen::Map<const Eigen::VectorXd>(right_.data(), n));
  Eigen::Map<Eigen::VectorXd>(polynomial.up.data(), n) =
      factors.solve(Eigen::Map<const Eigen::VectorXd>(up_.data(), n));
  return true;
}

}  // namespace weft::material
