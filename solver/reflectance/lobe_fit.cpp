// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/parallel.h"

namespace weft::solver {
namespace {

using Shared = Eigen::Matrix<double, kLobeParameters, 1>;
using SharedMatrix = Eigen::Matrix<double, kLobeParameters, kLobeParameters>;

// Dampings of one step, each eight times the one before; where the last wins nothing the fit is over.
constexpr int kMostTries = 7;
// What pixels need to follow a lobe that moved a little.
constexpr int kStepsARound = 2;
// Variance of a principal axis: what is less is an error of rounding.
constexpr double kLeastVariance = 1e-14;

Shared values_of(const Lobe& lobe) {
  if (lobe.family == LobeFamily::kTwoGgx)
    return {std::log(lobe.alpha), lobe.f0, std::log(lobe.broad), lobe.broad_share, lobe.bend};
  return {std::log(lobe.alpha), lobe.f0, std::log(lobe.along), lobe.axis, lobe.bend};
}

// Within the ranges of Lobe.
Lobe lobe_of(const Lobe& like, const Shared& v) {
  Lobe lobe = {.family = like.family,
               .alpha = std::exp(std::clamp(v[0], std::log(0.02), 0.0)),
               .f0 = std::clamp(v[1], 0.0, 0.6),
               .bend = std::clamp(v[4], -0.5, 1.0),
               .tint = like.tint};
  if (like.family == LobeFamily::kTwoGgx) {
    lobe.broad = std::exp(std::clamp(v[2], std::log(0.02), 0.0));
    lobe.broad_share = std::clamp(v[3], 0.0, 1.0);
  } else {
    lobe.along = std::exp(std::clamp(v[2], std::log(0.05), std::log(20.0)));
    lobe.axis = v[3];
  }
  return lobe;
}

// The largest change of a round.
constexpr std::array<double, kLobeParameters> kMostChange = {0.5, 0.1, 0.5, 0.35, 0.5};

// The equations of the fitted values; zero elsewhere.
struct Reduced {
  SharedMatrix matrix;
  Shared gradient;
};

Reduced reduced(const LobeSamples& samples, const LobeFit& fit, const LobeParameters& fitted, int threads) {
  std::vector<NudgedLobe> there;
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    if (fitted[p]) there.push_back(nudged(fit.lobe, static_cast<LobeParameter>(p)));
  }
  const SharedEquations all = samples.shared(fit.lobe, there, fit.yarn, fit.b, threads);
  Reduced sums;
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    sums.gradient[static_cast<Eigen::Index>(p)] = all.gradient[p];
    for (std::size_t q = 0; q < kLobeParameters; ++q)
      sums.matrix(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q)) = all.matrix[p][q];
  }
  return sums;
}

class SharedFit {
 public:
  SharedFit(const LobeSamples& samples, const LobeFitOptions& options)
      : samples_(samples), options_(options) {}

  LobeFit run(LobeFit fit) {
    fit = settled(std::move(fit), options_.first_steps);
    double damping = 1e-3;
    for (int round = 0; round < options_.rounds; ++round) {
      const Reduced sums = reduced(samples_, fit, options_.fitted, options_.threads);
      const std::optional<LobeFit> better = step(fit, sums, damping);
      if (!better) break;
      const bool is_last = fit.total() - better->total() < options_.settled * fit.total();
      fit = *better;
      damping = std::max(damping / 6, 1e-7);
      if (is_last) break;
    }
    const auto freedom = static_cast<double>(samples_.used()) - 3 * static_cast<double>(samples_.pixels());
    fit.chi2 = freedom > 0 ? 2 * fit.total() / freedom : 0;
    return fit;
  }

 private:
  bool is_fitted(Eigen::Index p) const { return options_.fitted[static_cast<std::size_t>(p)]; }

  // Every pixel solved for the lobe of the fit, from where it is.
  LobeFit settled(LobeFit fit, int steps) const {
    fit.cost.resize(samples_.pixels());
    samples_.fit_pixels(fit.lobe, fit.yarn, steps, options_.threads, fit.b, fit.cost);
    return fit;
  }

  // The next values, damped until the cost falls; none where it never does.
  std::optional<LobeFit> step(const LobeFit& fit, const Reduced& sums, double& damping) const {
    for (int tries = 0; tries < kMostTries; ++tries, damping *= 8) {
      SharedMatrix damped = sums.matrix;
      Shared gradient = sums.gradient;
      for (Eigen::Index p = 0; p < static_cast<Eigen::Index>(kLobeParameters); ++p) {
        damped(p, p) = is_fitted(p) ? damped(p, p) * (1 + damping) + 1e-12 : 1;
        if (!is_fitted(p)) gradient[p] = 0;
      }
      Shared change = damped.ldlt().solve(gradient);
      for (Eigen::Index p = 0; p < change.size(); ++p) {
        const double most = kMostChange[static_cast<std::size_t>(p)];
        change[p] = std::isfinite(change[p]) ? std::clamp(change[p], -most, most) : 0;
      }
      LobeFit next = fit;
      next.lobe = lobe_of(fit.lobe, values_of(fit.lobe) + change);
      next = settled(std::move(next), kStepsARound);
      if (next.total() < fit.total()) return next;
    }
    return {};
  }

  const LobeSamples& samples_;
  const LobeFitOptions& options_;
};

}  // namespace

void LobeSamples::add(std::span<const LobeReading> pixel) {
  const std::size_t lane = pixels() % LobeBlock::kPixels;
  if (lane == 0) blocks_.emplace_back(each_);
  blocks_.back().put(lane, pixel);
  readings_.insert(readings_.end(), pixel.begin(), pixel.end());
}

LobeSamples LobeSamples::first(std::size_t count) const {
  LobeSamples few(lights_, states(), scale_);
  for (std::size_t i = 0; i < std::min(count, pixels()); ++i) few.add(of(i));
  return few;
}

std::size_t LobeSamples::used() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(readings_, [](const LobeReading& r) { return r.weight > 0; }));
}

LobeBlock LobeSamples::block_at(std::size_t index, std::span<const double> yarn,
                                std::span<const Vec3> b) const {
  LobeBlock block = blocks_[index];
  for (std::size_t i = 0, pixel = index * LobeBlock::kPixels; i < LobeBlock::kPixels && pixel < pixels();
       ++i, ++pixel) {
    block.begin_at(i, b[pixel]);
    block.across[i] = yarn[pixel] > 0 ? 1 : 0;
  }
  return block;
}

void LobeSamples::fit_pixels(const Lobe& lobe, std::span<const double> yarn, int steps, int threads,
                             std::span<Vec3> b, std::span<double> cost) const {
  parallel_for(blocks_.size(), threads, [&](std::size_t i, int) {
    LobeBlock block = block_at(i, yarn, b);
    const std::size_t first = i * LobeBlock::kPixels, end = std::min(pixels(), first + LobeBlock::kPixels);
    fit_block(lobe, block, steps);
    for (std::size_t pixel = first; pixel < end; ++pixel) {
      b[pixel] = block.b(pixel - first);
      cost[pixel] = block.cost[pixel - first];
    }
  });
}

SharedEquations LobeSamples::shared(const Lobe& lobe, std::span<const NudgedLobe> nudged,
                                    std::span<const double> yarn, std::span<const Vec3> b,
                                    int threads) const {
  std::vector<SharedEquations> parts(blocks_.size());
  parallel_for(blocks_.size(), threads, [&](std::size_t i, int) {
    add_shared(lobe, nudged, block_at(i, yarn, b),
               std::min(LobeBlock::kPixels, pixels() - i * LobeBlock::kPixels), parts[i]);
  });
  SharedEquations all;
  for (const SharedEquations& part : parts) {
    for (std::size_t p = 0; p < kLobeParameters; ++p) {
      all.gradient[p] += part.gradient[p];
      for (std::size_t q = 0; q < kLobeParameters; ++q) all.matrix[p][q] += part.matrix[p][q];
    }
  }
  return all;
}

LobeParameters parameters_of(LobeFamily family) {
  LobeParameters fitted = {};
  const bool has_lobe = family != LobeFamily::kLambert, has_yarn = family == LobeFamily::kAnisotropicGgx;
  const bool has_two = family == LobeFamily::kTwoGgx;
  fitted[static_cast<std::size_t>(LobeParameter::kLogAlpha)] = has_lobe;
  fitted[static_cast<std::size_t>(LobeParameter::kF0)] = has_lobe;
  fitted[static_cast<std::size_t>(LobeParameter::kLogAlong)] = has_yarn || has_two;
  fitted[static_cast<std::size_t>(LobeParameter::kAxis)] = has_yarn || has_two;
  return fitted;
}

LobeParameters parameters_of(const Lobe& lobe, bool bends) {
  LobeParameters fitted = parameters_of(lobe.family);
  fitted[static_cast<std::size_t>(LobeParameter::kBend)] = bends;
  return fitted;
}

NudgedLobe nudged(const Lobe& lobe, LobeParameter parameter) {
  // Readings are linear in f0, and its range ends at 0.6.
  const double by = parameter != LobeParameter::kF0 ? 1e-3 : lobe.f0 < 0.3 ? 1e-2 : -1e-2;
  Shared there = values_of(lobe);
  there[static_cast<Eigen::Index>(parameter)] += by;
  return {lobe_of(lobe, there), by, static_cast<std::size_t>(parameter)};
}

NudgedLobes nudged(const Lobe& lobe, const LobeParameters& fitted) {
  NudgedLobes there;
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    if (fitted[p]) there[p] = nudged(lobe, static_cast<LobeParameter>(p));
  }
  return there;
}

std::vector<Lobe> one_sigma_off(const Lobe& lobe, const LobeCovariance& covariance) {
  SharedMatrix matrix;
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    for (std::size_t q = 0; q < kLobeParameters; ++q)
      matrix(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q)) = covariance[p][q];
  }
  const Eigen::SelfAdjointEigenSolver<SharedMatrix> principal(matrix);
  std::vector<Lobe> off;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const double variance = principal.eigenvalues()[i];
    if (!(variance > kLeastVariance)) continue;
    off.push_back(lobe_of(lobe, values_of(lobe) + std::sqrt(variance) * principal.eigenvectors().col(i)));
  }
  return off;
}

double LobeFit::total() const {
  return std::accumulate(cost.begin(), cost.end(), 0.0);
}

LobeFit fit_lobe(const LobeSamples& samples, LobeFit start, const LobeFitOptions& options) {
  return SharedFit(samples, options).run(std::move(start));
}

LobeCovariance covariance_of(const LobeSamples& samples, const LobeFit& fit, const LobeParameters& fitted,
                             int threads) {
  std::vector<Eigen::Index> free;
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    if (fitted[p]) free.push_back(static_cast<Eigen::Index>(p));
  }
  LobeCovariance covariance = {};
  if (free.empty()) return covariance;
  const Eigen::MatrixXd part = reduced(samples, fit, fitted, threads).matrix(free, free);
  const Eigen::MatrixXd inverse =
      std::max(fit.chi2, 1.0) * part.completeOrthogonalDecomposition().pseudoInverse();
  for (std::size_t i = 0; i < free.size(); ++i) {
    for (std::size_t j = 0; j < free.size(); ++j) {
      covariance[static_cast<std::size_t>(free[i])][static_cast<std::size_t>(free[j])] =
          inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  return covariance;
}

}  // namespace weft::solver
