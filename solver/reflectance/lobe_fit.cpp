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

// Pixels whose sums are made by one thread, in their order.
constexpr std::size_t kChunk = 64;
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

// What one chunk of pixels says of the shared values.
struct Reduced {
  SharedMatrix matrix = SharedMatrix::Zero();
  Shared gradient = Shared::Zero();
};

// Adds a pixel: M = S^T W S - (S^T W J)(J^T W J)^-1 (J^T W S), and likewise the gradient.
void add_pixel(const LobeSamples& samples, const LobeFit& fit, const NudgedLobes& there,
               const LobeParameters& fitted, std::size_t pixel, Reduced& sums) {
  const Vec3 b = fit.b[pixel];
  const double yarn = fit.yarn[pixel];
  PixelSystem system;
  std::array<Vec3, kLobeParameters> mixed = {};
  for (const LobeReading& r : samples.of(pixel)) {
    if (r.weight == 0) continue;
    const ModelledReading m = modelled_with_derivative(fit.lobe, b, r.from, yarn);
    const double residual = r.x - m.x;
    const double w = r.weight * huber_weight(residual * std::sqrt(r.weight));
    system.add(m.by_b, w, residual);
    Shared s = Shared::Zero();
    for (std::size_t p = 0; p < kLobeParameters; ++p) {
      if (!fitted[p]) continue;
      const double slope = (modelled(there[p].lobe, b, r.from, yarn) - m.x) / there[p].by;
      s[static_cast<Eigen::Index>(p)] = slope;
      mixed[p] = mixed[p] + (w * slope) * m.by_b;
    }
    sums.matrix += w * s * s.transpose();
    sums.gradient += w * residual * s;
  }
  system.regularise();
  for (std::size_t p = 0; p < kLobeParameters; ++p) {
    if (!fitted[p]) continue;
    const Vec3 solved = system.solved(mixed[p]);
    sums.gradient[static_cast<Eigen::Index>(p)] -= dot(solved, system.gradient);
    for (std::size_t q = 0; q < kLobeParameters; ++q) {
      if (fitted[q])
        sums.matrix(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q)) -= dot(solved, mixed[q]);
    }
  }
}

Reduced reduced(const LobeSamples& samples, const LobeFit& fit, const LobeParameters& fitted, int threads) {
  const std::size_t pixels = samples.pixels();
  const NudgedLobes there = nudged(fit.lobe, fitted);
  std::vector<Reduced> parts((pixels + kChunk - 1) / kChunk);
  parallel_for(parts.size(), threads, [&](std::size_t chunk, int) {
    for (std::size_t i = chunk * kChunk; i < std::min(pixels, (chunk + 1) * kChunk); ++i)
      add_pixel(samples, fit, there, fitted, i, parts[chunk]);
  });
  Reduced all;
  for (const Reduced& part : parts) {
    all.matrix += part.matrix;
    all.gradient += part.gradient;
  }
  return all;
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

void LobeSamples::fit_pixels(const Lobe& lobe, std::span<const double> yarn, int steps, int threads,
                             std::span<Vec3> b, std::span<double> cost) const {
  parallel_for(blocks_.size(), threads, [&](std::size_t i, int) {
    LobeBlock block = blocks_[i];
    const std::size_t first = i * LobeBlock::kPixels, end = std::min(pixels(), first + LobeBlock::kPixels);
    for (std::size_t pixel = first; pixel < end; ++pixel) {
      block.begin_at(pixel - first, b[pixel]);
      block.across[pixel - first] = yarn[pixel] > 0 ? 1 : 0;
    }
    fit_block(lobe, block, steps);
    for (std::size_t pixel = first; pixel < end; ++pixel) {
      b[pixel] = block.b(pixel - first);
      cost[pixel] = block.cost[pixel - first];
    }
  });
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
  const double by = parameter == LobeParameter::kF0 ? 1e-4 : 1e-3;
  Shared there = values_of(lobe);
  there[static_cast<Eigen::Index>(parameter)] += by;
  return {lobe_of(lobe, there), by};
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
