// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/vec.h"
#include "solver/in_double/pixel.h"

namespace weft::test {

/// One equation of a pixel:  weight * (reading / strength - direction . b)^2  is to be least in sum.
struct OracleRow {
  Vec3 direction;
  double strength = 1;
  double reading = 0;
  double weight = 1;
};

/// What exact arithmetic makes of the rows as they are, rounding errors of their making included.
struct OracleSolution {
  Vec3 normal;           ///< unit; as exact as a double
  double albedo = 0;     ///< |b|
  double condition = 0;  ///< of the weighted directions; infinity where their rank is below three
};

/// The equations of a pixel whose readings are finite and whose lights shine: of its one plane, or of the
/// luminance of three.
std::vector<OracleRow> oracle_rows(std::span<const solver::PixelRow> rows, int planes);

/// Least squares with 113 bits: QR by modified Gram-Schmidt and, for the condition number, one-sided Jacobi
/// rotations of R (Golub and Van Loan 2013, sections 5.2.8 and 8.6.3). At least three rows; exact to a double
/// up to a condition number of 1e15.
OracleSolution solve_in_quad(std::span<const OracleRow> rows);

/// Three rows by Cramer's rule with 113 bits.
OracleSolution solve_by_cramer(std::span<const OracleRow, 3> rows);

}  // namespace weft::test
