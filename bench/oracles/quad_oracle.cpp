// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/quad_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "solver/method.h"

namespace weft::test {
namespace {

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Quad;
#else
using Quad = long double;
#endif
static_assert(sizeof(Quad) == 16);

using Quad3 = std::array<Quad, 3>;
using Columns = std::array<std::vector<Quad>, 3>;

// Newton's method from the root of the leading 53 bits, which doubles the bits that are right.
Quad square_root(Quad v) {
  if (!(v > 0)) return 0;
  int exponent = 0;  // of a power of four, so that the leading bits fit a double
  while (v > Quad{1e200}) v /= Quad{0x1p200}, exponent += 100;
  while (v < Quad{1e-200}) v *= Quad{0x1p200}, exponent -= 100;
  Quad root = std::sqrt(static_cast<double>(v));
  for (int i = 0; i < 2; ++i) root = (root + v / root) / 2;
  for (; exponent > 0; exponent -= 100) root *= Quad{0x1p100};
  for (; exponent < 0; exponent += 100) root /= Quad{0x1p100};
  return root;
}

template <typename A, typename B>
Quad dot(const A& a, const B& b) {
  Quad sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

template <typename A>
Quad length(const A& a) {
  return square_root(dot(a, a));
}

OracleSolution solution_of(const Quad3& b) {
  const Quad rho = length(b);
  if (!(rho > 0)) return {{0, 0, 1}, 0, 0};
  return {{static_cast<double>(b[0] / rho), static_cast<double>(b[1] / rho), static_cast<double>(b[2] / rho)},
          static_cast<double>(rho),
          0};
}

// Rotates pairs of columns until all are orthogonal; their lengths are then the singular values.
double condition_of(std::array<Quad3, 3> columns) {
  for (int sweep = 0; sweep < 60; ++sweep) {
    for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
      Quad3 &a = columns[i], &b = columns[j];
      const Quad ab = dot(a, b);
      if (ab * ab <= Quad{1e-64} * dot(a, a) * dot(b, b)) continue;
      const Quad zeta = (dot(b, b) - dot(a, a)) / (2 * ab);
      const Quad t = (zeta < 0 ? -1 : 1) / ((zeta < 0 ? -zeta : zeta) + square_root(1 + zeta * zeta));
      const Quad c = 1 / square_root(1 + t * t), s = c * t;
      for (std::size_t r = 0; r < 3; ++r) {
        const Quad old = a[r];
        a[r] = c * old - s * b[r];
        b[r] = s * old + c * b[r];
      }
    }
  }
  const std::array<Quad, 3> sigma = {length(columns[0]), length(columns[1]), length(columns[2])};
  const auto [least, most] = std::minmax_element(sigma.begin(), sigma.end());
  const double share = static_cast<double>(*least / *most);
  return share > 1e-16 ? 1 / share : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<OracleRow> oracle_rows(std::span<const solver::PixelRow> rows, int planes) {
  std::vector<OracleRow> usable;
  for (const solver::PixelRow& row : rows) {
    if (planes == 1) {
      if (std::isfinite(row.reading[0]) && row.strength[0] > 0)
        usable.push_back({row.direction, row.strength[0], row.reading[0]});
      continue;
    }
    double light = 0;
    bool shines = true;
    for (std::size_t p = 0; p < 3; ++p) {
      light += solver::kLuminance[p] * (row.reading[p] / row.strength[p]);
      shines &= row.strength[p] > 0;
    }
    if (shines && std::isfinite(light)) usable.push_back({row.direction, 1, light});
  }
  return usable;
}

OracleSolution solve_in_quad(std::span<const OracleRow> rows) {
  Columns q;
  std::vector<Quad> x;
  for (const OracleRow& row : rows) {
    const Quad w = square_root(Quad{row.weight});
    q[0].push_back(w * row.direction.x);
    q[1].push_back(w * row.direction.y);
    q[2].push_back(w * row.direction.z);
    x.push_back(w * (Quad{row.reading} / Quad{row.strength}));
  }
  std::array<Quad3, 3> r = {};  // by columns
  Quad3 y = {};
  for (std::size_t j = 0; j < 3; ++j) {
    r[j][j] = length(q[j]);
    if (!(r[j][j] > 0)) return {{0, 0, 1}, 0, std::numeric_limits<double>::infinity()};
    for (Quad& v : q[j]) v /= r[j][j];
    for (std::size_t k = j + 1; k < 3; ++k) {
      r[k][j] = dot(q[j], q[k]);
      for (std::size_t i = 0; i < rows.size(); ++i) q[k][i] -= r[k][j] * q[j][i];
    }
    y[j] = dot(q[j], x);
    for (std::size_t i = 0; i < rows.size(); ++i) x[i] -= y[j] * q[j][i];
  }
  Quad3 b = y;
  for (std::size_t j = 3; j-- > 0;) {
    for (std::size_t k = j + 1; k < 3; ++k) b[j] -= r[k][j] * b[k];
    b[j] /= r[j][j];
  }
  OracleSolution s = solution_of(b);
  s.condition = condition_of(r);
  return s;
}

OracleSolution solve_by_cramer(std::span<const OracleRow, 3> rows) {
  std::array<Quad3, 4> column;  // of the matrix, and the right-hand side
  for (std::size_t k = 0; k < 3; ++k) {
    column[0][k] = rows[k].direction.x;
    column[1][k] = rows[k].direction.y;
    column[2][k] = rows[k].direction.z;
    column[3][k] = Quad{rows[k].reading} / Quad{rows[k].strength};
  }
  const auto determinant = [&](std::size_t a, std::size_t b, std::size_t c) -> Quad {
    const Quad3 &u = column[a], &v = column[b], &w = column[c];
    return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
  };
  const Quad whole = determinant(0, 1, 2);
  OracleSolution s =
      solution_of({determinant(3, 1, 2) / whole, determinant(0, 3, 2) / whole, determinant(0, 1, 3) / whole});
  s.condition = condition_of({column[0], column[1], column[2]});
  return s;
}

}  // namespace weft::test
