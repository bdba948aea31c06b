// SPDX-License-Identifier: Apache-2.0
#include "solver/frame_fit/room_light.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/statistics.h"

namespace weft::solver {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kMostCells = 6'000;
constexpr std::size_t kFewestGains = 6;
constexpr int kParts = 4;  // of the frame, a side
constexpr int kTurns = 8;  // kinds of tilt, by where it leans, each flat or steep
constexpr double kGainPrior = 0.03, kSharePrior = 0.3;  // sigma beforehand
constexpr double kLeastRelief_deg = 2;                  // rms: on flatter things gains of lights look like it
constexpr double kNoRoomFrom = 6;  // sigma, beyond which an error is no light of the room
constexpr double kToldFrom_sigmas = 5, kToldFromByTilt = 10;
// What a clean cloth shows at most, measured (docs/measured/conditions.md): always, of readings in shadow,
// and of what no noise explains.
constexpr double kDoubt = 0.004, kDoubtOfShadow = 0.08, kDoubtOfMisfit = 4;

// A cell's lit readings, over its brightness, off the span of their directions: what light and gains explain,
// and the rest.
struct CellPart {
  MatrixXd design;
  VectorXd rest;
};

// Least squares of the share and the gains: share first.
struct Equations {
  MatrixXd a;
  VectorXd rhs;

  explicit Equations(Eigen::Index unknowns)
      : a(MatrixXd::Zero(unknowns, unknowns)), rhs(VectorXd::Zero(unknowns)) {}
  // With gains beside it and without: on cloth that Lambert's law does not describe they differ, and the
  // smaller one is believed, none where they contradict each other.
  double share(const MatrixXd& prior) const {
    const double with_gains = (a + prior).ldlt().solve(rhs)[0], without = alone(prior);
    if (with_gains * without <= 0) return 0;
    return std::abs(with_gains) < std::abs(without) ? with_gains : without;
  }
  double alone(const MatrixXd& prior) const { return rhs[0] / (a(0, 0) + prior(0, 0)); }
  void add(const CellPart& part) {
    a += part.design.transpose() * part.design;
    rhs += part.design.transpose() * part.rest;
  }
};

// Variance of the share by leaving out each group in turn.
double jackknifed(const Equations& all, const std::vector<Equations>& groups, const MatrixXd& prior) {
  const double share = all.share(prior);
  double squares = 0;
  for (const Equations& group : groups) {
    Equations rest = all;
    rest.a -= group.a, rest.rhs -= group.rhs;
    squares += std::pow(rest.share(prior) - share, 2);
  }
  const auto count = static_cast<double>(groups.size());
  return squares * (count - 1) / count;
}

// Which way cells lean, and whether by more than half of them do.
class Tilts {
 public:
  explicit Tilts(const CellFit& fit) {
    std::vector<double> slopes;
    for (const Vec3& normal : fit.normal) {
      if (length(normal) > 0) slopes.push_back(angle_deg(normal, {0, 0, 1}));
    }
    half_deg_ = median(std::move(slopes));
  }
  static constexpr std::size_t kKinds = 2 * kTurns;
  std::size_t kind_of(const Vec3& normal) const {
    const double turn = std::atan2(normal.y, normal.x) / (2 * kPi) + 0.5;
    const auto side = std::min<std::size_t>(kTurns - 1, static_cast<std::size_t>(kTurns * turn));
    return 2 * side + (angle_deg(normal, {0, 0, 1}) > half_deg_ ? 1 : 0);
  }

 private:
  double half_deg_ = 0;
};

std::optional<CellPart> part_of(const FrameCells& cells, const CellFit& fit,
                                std::span<const FrameMisfit> misfits, std::size_t cell) {
  const std::size_t count = cells.count, from = cell * count;
  const float brightness = fit.brightness[cell];
  if (!(length(fit.normal[cell]) > 0)) return std::nullopt;
  double mean = 0;
  std::vector<std::size_t> lit;
  for (std::size_t k = 0; k < count; ++k) {
    const float value = cells.value[from + k];
    if (!std::isfinite(value)) return std::nullopt;  // full: its mean is not known
    mean += static_cast<double>(value) * static_cast<double>(cells.strength[from + k]) /
            static_cast<double>(count);
    if (!misfits[k].is_wrong() && is_lit(cells, fit, cell, k) &&
        std::abs(static_cast<double>(fit.error[from + k])) < kNoRoomFrom * fit.sigma)
      lit.push_back(k);
  }
  if (lit.size() < kFewestGains) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(lit.size());
  MatrixXd l(n, 3), design = MatrixXd::Zero(n, static_cast<Eigen::Index>(1 + count));
  VectorXd x(n);
  const double scale = 1 / static_cast<double>(brightness);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = lit[static_cast<std::size_t>(i)];
    const Vec3 direction = cells.direction[from + k];
    l.row(i) << direction.x, direction.y, direction.z;
    x[i] = scale * static_cast<double>(cells.value[from + k]);
    design(i, 0) = scale * mean / static_cast<double>(cells.strength[from + k]);
    // As it is predicted: a gain of all readings would else take away their noise.
    design(i, 1 + static_cast<Eigen::Index>(k)) = scale * dot(fit.normal[cell], direction);
  }
  const auto solved = (l.transpose() * l).ldlt();
  return CellPart{design - l * solved.solve(l.transpose() * design), x - l * solved.solve(l.transpose() * x)};
}

// Sigma of what light and gains leave, by its median.
double misfit_with(const VectorXd& solution, const std::vector<CellPart>& told) {
  constexpr double kMedianOfNormal = 0.6745, kUnknowns = 3;
  std::vector<double> left;
  for (const CellPart& part : told) {
    const VectorXd rest = part.rest - part.design * solution;
    const double share = 1 - kUnknowns / static_cast<double>(rest.size());  // of their variance that is left
    for (const double value : rest) left.push_back(std::abs(value) / std::sqrt(share));
  }
  return median(std::move(left)) / kMedianOfNormal;
}

// How far normals lie about their mean, rms degrees.
double relief_of(const CellFit& fit) {
  Vec3 mean;
  for (const Vec3& normal : fit.normal) {
    if (length(normal) > 0) mean = mean + normalized(normal);
  }
  if (!(length(mean) > 0)) return 0;
  double squares = 0, count = 0;
  for (const Vec3& normal : fit.normal) {
    if (!(length(normal) > 0)) continue;
    squares += std::pow(angle_deg(normal, mean), 2);
    ++count;
  }
  return std::sqrt(squares / count);
}

double unlit_share(const FrameCells& cells, const CellFit& fit) {
  std::int64_t all = 0, unlit = 0;
  for (std::size_t i = 0; i < cells.value.size(); ++i) {
    const float brightness = fit.brightness[i / cells.count];
    if (!std::isfinite(cells.value[i]) || !(brightness > 0)) continue;
    ++all;
    unlit += !is_lit(cells, fit, i / cells.count, i % cells.count);
  }
  return all > 0 ? static_cast<double>(unlit) / static_cast<double>(all) : 1;
}

}  // namespace

bool RoomShare::is_told() const {
  return std::abs(share) > std::max({doubt, kToldFrom_sigmas * sigma, kToldFromByTilt * by_tilt});
}

RoomShare find_room_light(const FrameCells& cells, const CellFit& fit, std::span<const FrameMisfit> misfits,
                          double noise) {
  const RoomShare none = {0, 0, 1, 1, 1};
  if (cells.count < kFewestGains || relief_of(fit) < kLeastRelief_deg) return none;
  const auto unknowns = static_cast<Eigen::Index>(1 + cells.count);
  const Tilts tilts(fit);
  std::vector<Equations> parts(kParts * kParts, Equations(unknowns)),
      kinds(Tilts::kKinds, Equations(unknowns));
  const std::size_t step = std::max<std::size_t>(1, cells.cells() / kMostCells) | 1U;
  const auto columns = static_cast<std::size_t>(cells.columns), rows = static_cast<std::size_t>(cells.rows);
  std::vector<CellPart> told;
  for (std::size_t cell = 0; cell < cells.cells(); cell += step) {
    std::optional<CellPart> part = part_of(cells, fit, misfits, cell);
    if (!part) continue;
    parts[cell / columns * kParts / rows * kParts + cell % columns * kParts / columns].add(*part);
    kinds[tilts.kind_of(fit.normal[cell])].add(*part);
    told.push_back(std::move(*part));
  }
  constexpr std::size_t kFewestCells = 200;
  if (told.size() < kFewestCells) return none;
  Equations all(unknowns);
  for (const Equations& part : parts) all.a += part.a, all.rhs += part.rhs;
  MatrixXd prior = MatrixXd::Zero(unknowns, unknowns);
  const auto precision = [&](double sigma) { return std::pow(fit.sigma / sigma, 2); };
  for (Eigen::Index k = 1; k < unknowns; ++k) prior(k, k) = precision(kGainPrior);
  prior(0, 0) = precision(kSharePrior);
  RoomShare found;
  const VectorXd solution = (all.a + prior).ldlt().solve(all.rhs);
  found.share = all.share(prior);
  found.alone = all.alone(prior);
  const double by_noise =
      (all.a + prior).ldlt().solve(VectorXd::Unit(unknowns, 0))[0] * fit.sigma * fit.sigma;
  found.sigma = std::sqrt(jackknifed(all, parts, prior) + std::max(0.0, by_noise));
  found.by_tilt = std::sqrt(jackknifed(all, kinds, prior));
  found.doubt = kDoubt + kDoubtOfShadow * unlit_share(cells, fit) +
                kDoubtOfMisfit * std::max(0.0, misfit_with(solution, told) - 2 * noise);
  return found;
}

}  // namespace weft::solver
