// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/image/image.h"

namespace weft::material {

/// A polynomial over a frame for each of two slopes, in products of Legendre polynomials of x and y, which
/// both run from -1 to 1 between the frame's borders.
class SlopePolynomial {
 public:
  static constexpr int kMostDegree = 5;
  using Axis = std::array<double, kMostDegree + 1>;  ///< values of P0, P1, ... at one place

  SlopePolynomial() = default;
  SlopePolynomial(Size size, int degree);

  static constexpr int terms(int degree) { return (degree + 1) * (degree + 2) / 2; }
  int degree() const { return degree_; }
  /// Where a column or row, whole numbers being centres of pixels, is between -1 and 1.
  Axis at_column(double x) const { return axis_at(x, size_.width); }
  Axis at_row(double y) const { return axis_at(y, size_.height); }

  /// Row y of both slopes, as wide as the frame.
  void read(int y, float* right, float* up) const;

  /// In the order of for_each_term.
  std::vector<double> right, up;

  /// body(term, i, j) for each product P_i(x) P_j(y), i + j <= degree.
  template <typename Body>
  static void for_each_term(int degree, const Body& body) {
    std::size_t term = 0;
    for (int i = 0; i <= degree; ++i) {
      for (int j = 0; i + j <= degree; ++j)
        body(term++, static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    }
  }

 private:
  static Axis axis_at(double place, int length);

  Size size_;
  int degree_ = 0;
};

/// Normal equations of a weighted fit of both slopes at once, which add up.
class SlopeFit {
 public:
  explicit SlopeFit(int degree);
  /// `values` are those of the terms.
  void add(const std::vector<double>& values, double weight, double right, double up);
  /// Pixels of a row together: moments of x, of weights and of weighted slopes, under the row's own weight.
  struct RowMoments {
    std::array<SlopePolynomial::Axis, SlopePolynomial::kMostDegree + 1> products = {};
    SlopePolynomial::Axis right = {}, up = {};
  };
  void add_row(const RowMoments& row, const SlopePolynomial::Axis& y, double weight);
  void add(const SlopeFit& other);

  /// Whether there is enough to tell all terms apart; writes the fit into `polynomial`, of the same degree.
  bool solve(SlopePolynomial& polynomial) const;

 private:
  int degree_;
  std::size_t terms_;
  std::vector<double> matrix_, right_, up_;
};

}  // namespace weft::material
