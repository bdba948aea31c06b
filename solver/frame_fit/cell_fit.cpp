// SPDX-License-Identifier: Apache-2.0
#include "solver/frame_fit/cell_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/base/parallel.h"
#include "core/base/statistics.h"

namespace weft::solver {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr int kRounds = 4;
constexpr double kFarFrom = 3;        // sigma, from which on a reading counts less
constexpr double kLeastSigma = 5e-4;  // of the brightness: no sensor is better over a filter cell
constexpr double kMedianToSigma = 1.4826;
constexpr std::size_t kFewestLit = 4;
constexpr std::size_t kMostSampled = 200'000;  // readings whose median is taken

// A symmetric matrix of 3 x 3 and its inverse.
struct Sums {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(double w, Vec3 a) {
    xx += w * a.x * a.x, xy += w * a.x * a.y, xz += w * a.x * a.z;
    yy += w * a.y * a.y, yz += w * a.y * a.z, zz += w * a.z * a.z;
  }
  Vec3 operator*(Vec3 v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  // None where the rows do not span three dimensions.
  std::optional<Sums> inverse() const {
    constexpr double kLeast = 1e-7;  // of the trace to the third
    const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
    const double determinant = xx * a + xy * b + xz * c, trace = xx + yy + zz;
    if (!(determinant > kLeast * trace * trace * trace)) return std::nullopt;
    const double s = 1 / determinant;
    return Sums{
        s * a, s * b, s * c, s * (xx * zz - xz * xz), s * (xy * xz - xx * yz), s * (xx * yy - xy * xy)};
  }
};

// Fits the cells of one row after another.
class RowFit {
 public:
  RowFit(const FrameCells& cells, CellFit& fit) : cells_(cells), fit_(fit) {}

  void brighten(std::size_t cell) {
    const std::span<const float> values = values_of(cell);
    std::array<float, 3> top = {};
    for (const float value : values) {
      if (!(value > top[2])) continue;
      top[2] = value;
      if (top[2] > top[1]) std::swap(top[1], top[2]);
      if (top[1] > top[0]) std::swap(top[0], top[1]);
    }
    fit_.brightness[cell] = top[2];
  }

  // `sigma` is that of the round before; 0: every lit reading counts alike.
  void solve(std::size_t cell, double sigma) {
    const std::size_t from = cell * cells_.count;
    const std::span<const float> values = values_of(cell);
    const double brightness = static_cast<double>(fit_.brightness[cell]);
    Sums sums;
    Vec3 right;
    weights_.assign(values.size(), 0);
    std::size_t lit = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!(brightness > 0) || !is_lit(cells_, fit_, cell, k)) continue;
      ++lit;
      const double error = sigma > 0 ? static_cast<double>(fit_.error[from + k]) / (kFarFrom * sigma) : 0;
      weights_[k] = std::isfinite(error) ? 1 / (1 + error * error) : 0;
      const Vec3 l = cells_.direction[from + k];
      sums.add(weights_[k], l);
      right = right + weights_[k] * static_cast<double>(values[k]) * l;
    }
    const std::optional<Sums> inverse = lit < kFewestLit ? std::nullopt : sums.inverse();
    fit_.normal[cell] = inverse ? *inverse * right : Vec3{};
    for (std::size_t k = 0; k < values.size(); ++k) {
      float& error = fit_.error[from + k];
      error = kMissing;
      if (!inverse || !std::isfinite(values[k])) continue;
      const Vec3 l = cells_.direction[from + k];
      const double own = std::min(0.9, weights_[k] * dot(l, *inverse * l));
      const double predicted = dot(fit_.normal[cell], l);
      // Light from behind is none.
      const double rest = static_cast<double>(values[k]) - std::max(0.0, predicted);
      error = static_cast<float>(rest / (brightness * (1 - own)));
    }
  }

 private:
  std::span<const float> values_of(std::size_t cell) const {
    return std::span(cells_.value).subspan(cell * cells_.count, cells_.count);
  }

  const FrameCells& cells_;
  CellFit& fit_;
  std::vector<double> weights_;
};

double sigma_of(const FrameCells& cells, const CellFit& fit) {
  const std::size_t step = std::max<std::size_t>(1, cells.value.size() / kMostSampled) | 1U;
  std::vector<float> errors;
  for (std::size_t i = 0; i < cells.value.size(); i += step) {
    if (is_lit(cells, fit, i / cells.count, i % cells.count) && std::isfinite(fit.error[i]))
      errors.push_back(std::abs(fit.error[i]));
  }
  if (errors.empty()) return 0;
  return std::max(kLeastSigma, kMedianToSigma * static_cast<double>(median(std::move(errors))));
}

CellFit fit_in_rounds(const FrameCells& cells, int rounds, int threads) {
  CellFit fit;
  fit.normal.resize(cells.cells());
  fit.brightness.resize(cells.cells());
  fit.error.resize(cells.value.size(), kMissing);
  for (int round = 0; round < rounds; ++round) {
    parallel_for(static_cast<std::size_t>(cells.rows), threads, [&](std::size_t row, int) {
      RowFit row_fit(cells, fit);
      const auto columns = static_cast<std::size_t>(cells.columns);
      for (std::size_t cell = row * columns; cell < (row + 1) * columns; ++cell) {
        if (round == 0) row_fit.brighten(cell);
        row_fit.solve(cell, fit.sigma);
      }
    });
    fit.sigma = sigma_of(cells, fit);
  }
  return fit;
}

}  // namespace

CellFit fit_cells(const FrameCells& cells, int threads) {
  return fit_in_rounds(cells, kRounds, threads);
}

CellFit plain_fit(const FrameCells& cells, int threads) {
  return fit_in_rounds(cells, 1, threads);
}

CellChange change_of(const CellFit& from, const CellFit& to) {
  double squares = 0;
  std::vector<double> ratios;
  for (std::size_t cell = 0; cell < from.normal.size(); ++cell) {
    const double before = length(from.normal[cell]), after = length(to.normal[cell]);
    if (!(before > 0) || !(after > 0)) continue;
    const double turned = angle_deg(from.normal[cell], to.normal[cell]);
    squares += turned * turned;
    ratios.push_back(after / before);
  }
  if (ratios.empty()) return {};
  const auto cells = static_cast<double>(ratios.size());
  return {std::sqrt(squares / cells), median(std::move(ratios)) - 1};
}

}  // namespace weft::solver
