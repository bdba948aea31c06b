// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "solver/registration/tile_system.h"

namespace weft::solver {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Block = Eigen::Matrix<double, 2, 3>;

constexpr int kMostRounds = 15;
constexpr double kDone_px = 0.002, kSettled_px = 10 * kDone_px;
// Rounds after which it shows whether they settle.
constexpr int kLeastRounds = 3;
// Where a round finds all shots within so many sigmas of each other, half of what counts, it is the last.
constexpr double kStill_sigmas = 1.5;
// Signal is believed in where it adds this share to the energy of noisy gradients.
constexpr double kLeastSignal = 0.1;
constexpr double kSignificant_sigmas = 3;  // of a component

// Where the tiles lie, in pixels from the frame's centre, and what displaces them: each shot has x, y and a
// turn, as pixels at the frame's corner so that all parameters are of one size.
class Layout {
 public:
  Layout(std::span<const TileInput> tiles, Size frame, Eigen::Index shots)
      : shots_(shots), corner_px_(std::hypot(frame.width, frame.height) / 2) {
    for (const TileInput& t : tiles) {
      x_.push_back((t.tile.x0 + t.tile.x1 - frame.width) / 2.0);
      y_.push_back((t.tile.y0 + t.tile.y1 - frame.height) / 2.0);
    }
  }
  Eigen::Index unknowns() const { return 3 * shots_; }
  // Shots whose parameters are solved together.
  Eigen::Index group() const { return shots_ > kMostTogether ? 1 : std::max<Eigen::Index>(shots_, 1); }
  // Displacement (x, y) of a shot in a tile from its parameters; that of all shots has one such block each.
  Block jacobian(std::size_t tile) const {
    Block j = Block::Identity();
    j.col(2) << y_[tile] / corner_px_, -x_[tile] / corner_px_;
    return j;
  }
  ClothShift shift(const VectorXd& parameters, Eigen::Index k) const {
    return {parameters[3 * k], parameters[3 * k + 1], parameters[3 * k + 2] / corner_px_};
  }
  ClothShift::Displacement at(const ClothShift& shift, std::size_t tile) const {
    return shift.at(x_[tile], y_[tile]);
  }
  double most_px(const VectorXd& parameters) const {
    double most = 0;
    for (Eigen::Index k = 0; k < shots_; ++k) {
      for (std::size_t t = 0; t < x_.size(); ++t) {
        const ClothShift::Displacement d = at(shift(parameters, k), t);
        most = std::max(most, std::hypot(d.x, d.y));
      }
    }
    return most;
  }
  std::size_t tiles() const { return x_.size(); }

 private:
  Eigen::Index shots_;
  double corner_px_;
  std::vector<double> x_, y_;
};

// The systems of all tiles as one in the parameters of a group.
struct Group {
  MatrixXd information, noise, scatter;  // scatter: covariance of `score`
  VectorXd score;
};
struct Whole {
  std::vector<Group> groups;
  double information = 0, scatter = 0;  // traces
  double chi2 = 0, freedom = 0, floor = 0;
};

// J^T M J by blocks, of the lower triangle.
void add_information(const GroupInformation& known, const Block& j, Group& group) {
  const Eigen::Matrix3d noise = j.transpose() * j;
  for (Eigen::Index k = 0; k < known.noise.rows(); ++k) {
    for (Eigen::Index c = 0; c <= k; ++c) {
      Eigen::Matrix2d pair = known.information.block<2, 2>(2 * k, 2 * c);
      if (c == k) pair(0, 1) = pair(1, 0);
      group.information.block<3, 3>(3 * k, 3 * c) += j.transpose() * pair * j;
      group.noise.block<3, 3>(3 * k, 3 * c) += known.noise(k, c) * noise;
    }
  }
}

Whole gather(const std::vector<TileSystem>& systems, const Layout& layout) {
  const Eigen::Index n = 3 * layout.group(), displacements = 2 * layout.group();
  Whole w;
  w.groups.assign(static_cast<std::size_t>(layout.unknowns() / n),
                  {MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), VectorXd::Zero(n)});
  double squares = 0;
  for (std::size_t t = 0; t < systems.size(); ++t) {
    const TileSystem& s = systems[t];
    if (s.points == 0) continue;
    const Block j = layout.jacobian(t);
    for (std::size_t g = 0; g < w.groups.size(); ++g) {
      Group& group = w.groups[g];
      add_information(s.groups[g], j, group);
      for (const VectorXd& block : s.block_scores) {
        const auto of_group = block.segment(static_cast<Eigen::Index>(g) * displacements, displacements);
        VectorXd score(n);
        for (Eigen::Index k = 0; k < layout.group(); ++k)
          score.segment<3>(3 * k) = j.transpose() * of_group.segment<2>(2 * k);
        group.score += score;
        group.scatter += score * score.transpose();
      }
    }
    w.chi2 += s.chi2;
    w.freedom += s.freedom;
    squares += s.squares;
  }
  for (Group& group : w.groups) {
    group.information = MatrixXd(group.information.selfadjointView<Eigen::Lower>());
    group.noise = MatrixXd(group.noise.selfadjointView<Eigen::Lower>());
    w.information += group.information.trace();
    w.scatter += group.scatter.trace();
  }
  w.floor = w.freedom > 0 ? squares / w.freedom : 0;
  return w;
}

// What is left of the information once the energy that noise lends to gradients is taken off, in the
// directions that stand out of it. `size`: of the information of a parameter, on average.
MatrixXd signal_of(const Group& group, double size) {
  const Eigen::Index n = group.noise.rows();
  if (!(size > 0)) return MatrixXd::Zero(n, n);
  const MatrixXd noise = group.noise + 1e-6 * size * MatrixXd::Identity(n, n);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(group.information, noise);
  const VectorXd signal =
      modes.eigenvalues().unaryExpr([](double v) { return v > 1 + kLeastSignal ? v - 1 : 0.0; });
  const MatrixXd basis = noise * modes.eigenvectors();
  return basis * signal.asDiagonal() * basis.transpose();
}

struct Step {
  VectorXd parameters;
  std::vector<MatrixXd> covariances;  // by group
};

// Ridge regression towards no shift, whose error is scatter of the score and what the ridge holds back.
Step step_from(const VectorXd& parameters, const Whole& w) {
  const double prior2 = kUnknownShift_px * kUnknownShift_px;
  const double variance_of_score = w.information > 0 ? w.scatter / w.information : 1;
  const double ridge = std::max(variance_of_score / prior2, 1e-9 * w.information + 1e-300);
  const double size = w.information / static_cast<double>(parameters.size());
  Step step = {parameters, {}};
  for (std::size_t g = 0; g < w.groups.size(); ++g) {
    const Group& group = w.groups[g];
    const Eigen::Index n = group.score.size(), first = static_cast<Eigen::Index>(g) * n;
    const MatrixXd identity = MatrixXd::Identity(n, n), signal = signal_of(group, size);
    const MatrixXd gain = (signal + ridge * identity).ldlt().solve(identity);
    const MatrixXd held_back = gain * signal - identity;
    step.parameters.segment(first, n) += gain * (group.score - ridge * parameters.segment(first, n));
    step.covariances.emplace_back(gain * group.scatter * gain.transpose() +
                                  prior2 * held_back * held_back.transpose());
  }
  return step;
}

// Takes the mean of all shots off each component.
void centre(VectorXd& parameters) {
  Eigen::Map<Eigen::Matrix3Xd> shots(parameters.data(), 3, parameters.size() / 3);
  const Eigen::Vector3d mean = shots.rowwise().mean();
  shots.colwise() -= mean;
}
// That of shots which are known against each other alone. One that is solved by itself is known against all.
MatrixXd centred(const MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows(), shots = n / 3;
  MatrixXd q = MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < shots; ++k) q(i, 3 * k + i % 3) -= 1.0 / static_cast<double>(shots);
  }
  return q * covariance * q.transpose();
}

// Takes the (lower) median of all shots off each component.
void measure_from_median(VectorXd& parameters) {
  const Eigen::Index shots = parameters.size() / 3;
  for (Eigen::Index c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (Eigen::Index k = 0; k < shots; ++k) values.push_back(parameters[3 * k + c]);
    const double middle = lower_quantile(std::move(values), 0.5);
    for (Eigen::Index k = 0; k < shots; ++k) parameters[3 * k + c] -= middle;
  }
}

// Displacement of a shot, root mean square of both components over the tiles.
double rms_px(const ClothShift& shift, const Layout& layout) {
  double square = 0;
  for (std::size_t t = 0; t < layout.tiles(); ++t) {
    const ClothShift::Displacement d = layout.at(shift, t);
    square += (d.x * d.x + d.y * d.y) / 2;
  }
  return std::sqrt(square / static_cast<double>(layout.tiles()));
}

// Standard deviation of a component over the shots, from the middle one of them: some may have moved.
double spread_px(const VectorXd& parameters, const Layout& layout) {
  constexpr double kMedianOfRms = 0.8326;  // of two normal numbers of standard deviation 1: sqrt(ln 2)
  std::vector<double> rms;
  for (Eigen::Index k = 0; 3 * k < parameters.size(); ++k)
    rms.push_back(rms_px(layout.shift(parameters, k), layout));
  return rms.empty() ? 0 : lower_quantile(std::move(rms), 0.5) / kMedianOfRms;
}

// `spread_px` is what the shots' own spread adds to the error of each.
std::vector<ShotRegistration> describe(const VectorXd& parameters, const std::vector<MatrixXd>& covariances,
                                       const std::vector<TileSystem>& systems, const Layout& layout,
                                       double spread_px) {
  std::vector<ShotRegistration> shots;
  const auto tiles = static_cast<double>(layout.tiles());
  double readings = 0, shadowed = 0;
  for (const TileSystem& s : systems) {
    readings += s.readings;
    shadowed += s.shadowed;
  }
  const double model_px = kModelShift_px + (readings > 0 ? kModelShiftOfShadow_px * shadowed / readings : 0);
  for (Eigen::Index k = 0; 3 * k < parameters.size(); ++k) {
    const Eigen::Index at = k % layout.group();
    const MatrixXd& covariance = covariances[static_cast<std::size_t>(k / layout.group())];
    ShotRegistration s;
    s.shift = layout.shift(parameters, k);
    double variance = model_px * model_px + spread_px * spread_px, cost2 = 0, points = 0;
    for (std::size_t t = 0; t < layout.tiles(); ++t) {
      const Block j = layout.jacobian(t);
      variance += (j * covariance.block<3, 3>(3 * at, 3 * at) * j.transpose()).trace() / 2 / tiles;
      const ClothShift::Displacement d = layout.at(s.shift, t);
      const Eigen::Vector2d v(d.x, d.y);
      cost2 += std::max(0.0, v.dot(systems[t].cost[static_cast<std::size_t>(k)] * v));
      points += systems[t].points;
    }
    s.sigma_px = std::sqrt(variance);
    s.cost_deg = points > 0 ? degrees(std::sqrt(cost2 / points)) : 0;
    s.significant = rms_px(s.shift, layout) > kSignificant_sigmas * s.sigma_px;
    shots.push_back(s);
  }
  return shots;
}

// Whether each shot lies within its error of the others.
bool none_stands_out(VectorXd parameters, const std::vector<MatrixXd>& covariances,
                     const std::vector<TileSystem>& systems, const Layout& layout) {
  measure_from_median(parameters);
  return std::ranges::all_of(
      describe(parameters, covariances, systems, layout, 0),
      [&](const ShotRegistration& s) { return rms_px(s.shift, layout) < kStill_sigmas * s.sigma_px; });
}

// Whether rounds that go on getting shorter as the last did settle in as many as are left.
bool will_settle(double before_px, double last_px, int left) {
  return last_px * std::pow(last_px / before_px, left) < kSettled_px;
}

}  // namespace

Registration register_shots(std::span<const TileInput> tiles, Size frame, int threads) {
  const auto shots = static_cast<Eigen::Index>(tiles.empty() ? 0 : tiles.front().field->count());
  const Layout layout(tiles, frame, shots);
  std::vector<TileShots> looked_at(tiles.begin(), tiles.end());
  std::vector<TileSystem> systems(tiles.size());
  VectorXd parameters = VectorXd::Zero(layout.unknowns());
  ResidualScale scale;
  Registration result;
  Step step;
  double first_misfit = 0, misfit = 0, moved_px = std::numeric_limits<double>::infinity();
  for (int round = 0;; ++round) {
    parallel_for(tiles.size(), threads, [&](std::size_t t, int) {
      std::vector<ClothShift::Displacement> shifts;
      for (Eigen::Index k = 0; k < shots; ++k) shifts.push_back(layout.at(layout.shift(parameters, k), t));
      systems[t] = looked_at[t].system_at(shifts, scale, static_cast<std::size_t>(layout.group()));
    });
    const Whole whole = gather(systems, layout);
    misfit = whole.floor;
    if (round == 0) first_misfit = misfit;
    scale = {whole.floor, whole.freedom > 0 ? whole.chi2 / whole.freedom : scale.chi2};
    step = step_from(parameters, whole);
    if (step.covariances.size() == 1) step.covariances.front() = centred(step.covariances.front());
    if (moved_px < kDone_px || round == kMostRounds) break;
    centre(step.parameters);
    const double moved_before_px = moved_px;
    moved_px = layout.most_px(step.parameters - parameters);
    if (!(layout.most_px(step.parameters) < kMostShift_px)) {
      result.found = false;
      break;
    }
    parameters = step.parameters;
    if (none_stands_out(parameters, step.covariances, systems, layout)) {
      moved_px = 0;
      break;
    }
    if (round >= kLeastRounds && !will_settle(moved_before_px, moved_px, kMostRounds - round)) break;
  }
  result.found = result.found && moved_px < kSettled_px && misfit <= first_misfit;
  measure_from_median(parameters);
  result.explained = first_misfit > 0 ? 1 - misfit / first_misfit : 0;
  const bool is_movement = result.explained > kExplainedByMovement;
  result.shots = describe(parameters, step.covariances, systems, layout,
                          is_movement ? 0 : spread_px(parameters, layout));
  return result;
}

}  // namespace weft::solver
