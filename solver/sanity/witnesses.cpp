// SPDX-License-Identifier: Apache-2.0
#include "solver/sanity/witnesses.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace weft::solver {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kFewestBlocks = 50;
constexpr double kMostWork = 4e8;        // multiplications of one witness
constexpr double kWorstCondition = 1e4;  // of the lights' normal equations
constexpr double kSteepest = 0.3;        // nz: beyond it slopes are mostly noise

double median_of(std::vector<double>& values) {
  if (values.size() < kFewestBlocks) return kNone;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Lights as rows, in another order where one is given, and a column of ones for a constant.
Eigen::MatrixXd matrix_of(const std::vector<Vec3>& lights, bool has_constant,
                          std::span<const std::size_t> order) {
  Eigen::MatrixXd a(static_cast<Eigen::Index>(lights.size()), has_constant ? 4 : 3);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const Vec3& light = lights[order.empty() ? k : order[k]];
    const auto row = static_cast<Eigen::Index>(k);
    a.row(row).head<3>() << light.x, light.y, light.z;
    if (has_constant) a(row, 3) = 1;
  }
  return a;
}

// A^+, where the lights tell all unknowns.
std::optional<Eigen::MatrixXd> inverse_of(const Eigen::MatrixXd& a) {
  if (a.rows() < a.cols()) return std::nullopt;
  const Eigen::MatrixXd normal = a.transpose() * a;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(normal);
  const auto& values = parts.eigenvalues();
  if (!(values(0) > 0) || values(values.size() - 1) > kWorstCondition * values(0)) return std::nullopt;
  return normal.ldlt().solve(a.transpose());
}

// Reading minus what the other lights predict, as a matrix on the readings: (1 - h_k)^-1 (I - A A^+).
std::optional<Eigen::MatrixXd> left_out_matrix(const Eigen::MatrixXd& a) {
  constexpr double kTold = 1e-6;  // 1 - h: a light that no other says anything of
  const std::optional<Eigen::MatrixXd> inverse = inverse_of(a);
  if (!inverse || a.rows() == a.cols()) return std::nullopt;
  Eigen::MatrixXd residual = -a * *inverse;
  residual.diagonal().array() += 1;
  for (Eigen::Index k = 0; k < residual.rows(); ++k) {
    const double own = residual(k, k);
    residual.row(k) *= own > kTold ? 1 / own : 0;
  }
  return residual;
}

// Calls visit(readings) for the blocks of a tile that have all readings and some light, but for so many that
// the work stays bounded.
template <typename Visit>
void for_each_block(const BlockTile& tile, std::size_t step, const Visit& visit) {
  const std::size_t count = tile.lights.size();
  for (std::size_t block = 0; block * count < tile.readings.size(); block += step) {
    const Eigen::Map<const Eigen::VectorXf> readings(&tile.readings[block * count],
                                                     static_cast<Eigen::Index>(count));
    if (readings.allFinite() && readings.mean() > 0) visit(readings.cast<double>());
  }
}

std::size_t step_for(std::span<const BlockTile> tiles) {
  double work = 0;
  for (const BlockTile& tile : tiles)
    work += static_cast<double>(tile.readings.size()) * static_cast<double>(tile.lights.size());
  return static_cast<std::size_t>(std::max(1.0, std::ceil(work / kMostWork)));
}

double left_out(std::span<const BlockTile> tiles, bool has_constant, std::span<const std::size_t> order,
                const std::function<double(double)>& curve) {
  const std::size_t step = step_for(tiles);
  std::vector<double> errors;
  for (const BlockTile& tile : tiles) {
    const auto matrix = left_out_matrix(matrix_of(tile.lights, has_constant, order));
    if (!matrix) return std::numeric_limits<double>::infinity();
    for_each_block(tile, step, [&](Eigen::VectorXd readings) {
      if (curve) readings = readings.unaryExpr(curve);
      const double rms = (*matrix * readings).norm() / std::sqrt(static_cast<double>(readings.size()));
      errors.push_back(rms / readings.mean());
    });
  }
  const double error = median_of(errors);
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

struct Slope {
  double p = kNone, q = kNone;
};

std::vector<Slope> slopes_of(const BlockTile& tile) {
  const std::size_t count = tile.lights.size();
  std::vector<Slope> slopes(tile.readings.size() / std::max<std::size_t>(count, 1));
  const auto inverse = inverse_of(matrix_of(tile.lights, false, {}));
  if (!inverse) return slopes;
  for (std::size_t block = 0; block < slopes.size(); ++block) {
    const Eigen::Map<const Eigen::VectorXf> readings(&tile.readings[block * count],
                                                     static_cast<Eigen::Index>(count));
    const Eigen::Vector3d g = *inverse * readings.cast<double>();
    if (g.allFinite() && g.z() > kSteepest * g.norm()) slopes[block] = {-g.x() / g.z(), -g.y() / g.z()};
  }
  return slopes;
}

// dp/dx, dp/dy, dq/dx, dq/dy at (x, y), with y up, over two blocks.
std::array<double, 4> derivatives_at(const std::vector<Slope>& slopes, int width, int x, int y) {
  const auto at = [&](int ax, int ay) { return slopes[static_cast<std::size_t>(ay * width + ax)]; };
  const Slope east = at(x + 1, y), west = at(x - 1, y), north = at(x, y - 1), south = at(x, y + 1);
  return {east.p - west.p, north.p - south.p, east.q - west.q, north.q - south.q};
}

}  // namespace

double left_out_error(std::span<const BlockTile> tiles, bool has_constant) {
  return left_out(tiles, has_constant, {}, nullptr);
}

double left_out_error_through(std::span<const BlockTile> tiles, const std::function<double(double)>& curve) {
  return left_out(tiles, false, {}, curve);
}

double left_out_error_in_order(std::span<const BlockTile> tiles, std::span<const std::size_t> order) {
  return left_out(tiles, false, order, nullptr);
}

// If the true lights are M times the given ones, with an orthogonal M, the true slopes are M times the solved
// ones.
std::array<double, kSymmetries> curls(std::span<const BlockTile> tiles) {
  std::array<std::vector<double>, kSymmetries> all;
  for (const BlockTile& tile : tiles) {
    const std::vector<Slope> slopes = slopes_of(tile);
    for (int y = 1; y + 1 < tile.height; ++y) {
      for (int x = 1; x + 1 < tile.width; ++x) {
        const auto [px, py, qx, qy] = derivatives_at(slopes, tile.width, x, y);
        if (!std::isfinite(px + py + qx + qy)) continue;
        all[0].push_back(std::abs(py - qx));  // (p, q)
        all[1].push_back(std::abs(py + qx));  // (p, -q)
        all[2].push_back(std::abs(qy + px));  // (q, -p)
        all[3].push_back(std::abs(qy - px));  // (q, p)
      }
    }
  }
  std::array<double, kSymmetries> medians = {};
  std::ranges::transform(all, medians.begin(), median_of);
  return medians;
}

double constant_share(std::span<const BlockTile> tiles) {
  const std::size_t step = step_for(tiles);
  std::vector<double> shares;
  for (const BlockTile& tile : tiles) {
    const auto inverse = inverse_of(matrix_of(tile.lights, true, {}));
    if (!inverse) return kNone;
    for_each_block(tile, step, [&](const Eigen::VectorXd& readings) {
      shares.push_back(inverse->row(3).dot(readings) / readings.mean());
    });
  }
  return median_of(shares);
}

}  // namespace weft::solver
