// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec.h"
#include "core/rig/albedo_scale.h"
#include "solver/reflectance/lobe.h"
#include "solver/reflectance/lobe_block.h"
#include "solver/reflectance/pixel_fit.h"

// One lobe fitted to many pixels of one material, the normal and the albedo of each free: variable
// projection (Golub and Pereyra 1973).

namespace weft::solver {

/// Pixels of one material, each with all lights, once or in two states of films: first all of the one.
class LobeSamples {
 public:
  explicit LobeSamples(std::size_t lights, std::size_t states = 1, AlbedoScale scale = AlbedoScale::kAbsolute)
      : lights_(lights), each_(lights * states), scale_(scale) {}
  void add(std::span<const LobeReading> pixel);

  std::size_t lights() const { return lights_; }
  std::size_t states() const { return each_ / lights_; }
  AlbedoScale scale() const { return scale_; }  ///< of the readings, and of what is fitted to them
  std::size_t pixels() const { return readings_.size() / each_; }
  std::span<const LobeReading> of(std::size_t pixel) const {
    return {readings_.data() + pixel * each_, each_};
  }
  LobeSamples first(std::size_t count) const;
  std::size_t used() const;  ///< readings with a weight

  /// Every pixel's b and cost for a lobe, from where they are (fit_block). `yarn` is by pixel.
  void fit_pixels(const Lobe& lobe, std::span<const double> yarn, int steps, int threads, std::span<Vec3> b,
                  std::span<double> cost) const;
  /// What all pixels say of the values that are nudged (add_shared), each at its b.
  SharedEquations shared(const Lobe& lobe, std::span<const NudgedLobe> nudged, std::span<const double> yarn,
                         std::span<const Vec3> b, int threads) const;

 private:
  LobeBlock block_at(std::size_t index, std::span<const double> yarn, std::span<const Vec3> b) const;

  std::size_t lights_, each_;  // each_: readings of a pixel
  AlbedoScale scale_;
  std::vector<LobeReading> readings_;  // [pixel * each_ + state * lights_ + light]
  std::vector<LobeBlock> blocks_;      // the same for the vector kernel
};

/// What all pixels share, in the order of a covariance. A yarn's values and those of a broad lobe stand in
/// one place: no family has both.
enum class LobeParameter {
  kLogAlpha,
  kF0,
  kLogAlong,
  kAxis,
  kBend,
  kLogBroad = kLogAlong,
  kBroadShare = kAxis
};
using LobeParameters = std::array<bool, kLobeParameters>;  ///< which are fitted
using LobeCovariance = std::array<std::array<double, kLobeParameters>, kLobeParameters>;

/// Those of a family: alpha and f0 where it has a lobe, `along` and `axis` where it has a yarn, `broad` and
/// `broad_share` where it has two lobes.
LobeParameters parameters_of(LobeFamily family);
/// Those of a lobe's family, and its bend where the diffuse part `bends`.
LobeParameters parameters_of(const Lobe& lobe, bool bends);

NudgedLobe nudged(const Lobe& lobe, LobeParameter parameter);
/// By each of the fitted parameters; the others are not filled in.
using NudgedLobes = std::array<NudgedLobe, kLobeParameters>;
NudgedLobes nudged(const Lobe& lobe, const LobeParameters& fitted);

/// Lobes one sigma away, one along each principal axis of a covariance: any quantity's variance is to first
/// order the sum of the squares of what it changes by to each. None along an axis where nothing is open.
std::vector<Lobe> one_sigma_off(const Lobe& lobe, const LobeCovariance& covariance);

struct LobeFit {
  Lobe lobe;
  std::vector<Vec3> b;       ///< by pixel
  std::vector<double> yarn;  ///< by pixel: 0 or pi / 2, from the axis
  std::vector<double> cost;  ///< by pixel
  double chi2 = 0;           ///< twice the cost over the degrees of freedom that pixels leave

  double total() const;
};

struct LobeFitOptions {
  LobeParameters fitted = {};
  int rounds = 10;        ///< of the shared parameters; 0: pixels alone
  double settled = 1e-6;  ///< of the cost: a round that wins less is the last
  int first_steps = 5;    ///< of each pixel, before the first round
  int threads = 0;        ///< the result does not depend on them
};

/// Settles fits that only decide where to begin, or which pixels go together.
inline constexpr double kCoarselySettled = 1e-3;

/// From `start`, whose b and yarn are one a pixel. Each pixel's b by Gauss-Newton for given shared values,
/// these by Levenberg and Marquardt on what the pixels leave of the normal equations. Parameters stay within
/// Lobe's ranges. The cost never rises.
LobeFit fit_lobe(const LobeSamples& samples, LobeFit start, const LobeFitOptions& options);

/// The covariance of the fitted parameters of a fit, zero elsewhere; of a chi2 over 1 as large as the
/// residuals say.
LobeCovariance covariance_of(const LobeSamples& samples, const LobeFit& fit, const LobeParameters& fitted,
                             int threads);

}  // namespace weft::solver
