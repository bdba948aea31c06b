// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "solver/reflectance/lobe.h"
#include "solver/reflectance/pixel_fit.h"

namespace weft::solver {

/// Up to kRowGroup pixels side by side, as the vector kernels read them. Fields are filled by the kernels;
/// what they hold in lanes without a pixel is finite and means nothing.
class LobeBlock {
 public:
  static constexpr std::size_t kPixels = kRowGroup;
  using Lane = std::array<float, kPixels>;
  struct Lanes3 {
    Lane x = {}, y = {}, z = {};
  };
  struct Light {
    Lanes3 to_light, half;
    Lane grazing = {};  ///< (1 - l . h)^5
    Lane reading = {};
    Lane root_weight = {};  ///< one over sigma; 0 leaves the reading out
    Lane lobe_share = {};   ///< LitFrom::lobe_share; poses of one block may differ
  };

  explicit LobeBlock(std::size_t lights) : lights_(lights) {}

  /// Readings of a pixel that is not solved yet.
  void put(std::size_t pixel, std::span<const LobeReading> readings);
  /// Where the next fit begins.
  void begin_at(std::size_t pixel, Vec3 b);
  /// Copies a pixel of another block, with what is solved of it.
  void copy(std::size_t pixel, const LobeBlock& other, std::size_t other_pixel);
  /// Takes a pixel's readings away: its cost becomes 0.
  void leave_out(std::size_t pixel);
  /// Forgets what was solved.
  void reset();

  LobeReading reading(std::size_t pixel, std::size_t light) const;
  Vec3 b(std::size_t pixel) const { return {solved.x[pixel], solved.y[pixel], solved.z[pixel]}; }

  const std::vector<Light>& lights() const { return lights_; }
  std::vector<Light>& lights() { return lights_; }

  Lanes3 view;
  Lane channel = {};   ///< LitFrom::channel, plus one
  Lane used = {};      ///< how many readings have a weight
  Lanes3 start;        ///< b
  Lanes3 solved;       ///< b; nothing yet where `cost` is infinite
  Lane cost = {};      ///< as of fit_pixel
  Lane lobe = {};      ///< by which of several
  Lane across = {};    ///< 1 where the yarn lies across the lobe's axis, else 0
  Lane residual = {};  ///< rms of reading less model, over those with a weight
  /// J^T W J at the solution, by b along the normal, along the yarn and across it: 00, 01, 02, 11, 12, 22.
  std::array<Lane, 6> normal_matrix = {};

 private:
  std::vector<Light> lights_;
};

/// fit_pixel for a whole block, in float32 vectors: from `start` on, with the yarns as `across` says, at most
/// so many steps. No pixel's result depends on the others.
void fit_block(const Lobe& lobe, LobeBlock& block, int steps);

/// fit_pixel for the first `pixels` of a block, to a fiftieth of its sigma: from `start` on, with both yarns
/// where the family has them. Where that costs less than what is solved it takes its place, as number `index`
/// of several lobes. A fit that cannot come below what is solved any more is given up.
void improve_block(const Lobe& lobe, std::size_t index, LobeBlock& block, std::size_t pixels);

/// Values of a lobe that many pixels may share.
inline constexpr std::size_t kLobeParameters = 5;

/// A lobe with one of its values, number `parameter`, larger by `by`: what slopes are taken from.
struct NudgedLobe {
  Lobe lobe;
  double by = 0;
  std::size_t parameter = 0;
};

/// Normal equations of the shared values, b of every pixel eliminated: matrix * change = gradient.
struct SharedEquations {
  std::array<std::array<double, kLobeParameters>, kLobeParameters> matrix = {};
  std::array<double, kLobeParameters> gradient = {};
};
/// Adds what the first `pixels` of a block say at their `start`, with their yarns as `across` says: M = S^T W
/// S - (S^T W J)(J^T W J)^-1 (J^T W S) with the slopes S by the values that are nudged and Huber's weights W,
/// and likewise the gradient. In float32 but for the sums over pixels.
void add_shared(const Lobe& lobe, std::span<const NudgedLobe> nudged, const LobeBlock& block,
                std::size_t pixels, SharedEquations& sums);

/// Variances of b along its normal, which is that of the albedo, and across it, which is that of both
/// directions together.
struct BlockVariances {
  LobeBlock::Lane along_of_readings = {}, across_of_readings = {};
  LobeBlock::Lane along_of_lobe = {}, across_of_lobe = {};
};
/// Variances of every pixel as it stands, for lobes of the family of `lobe`, by which it was solved, that are
/// one sigma off: (J^T W J)^-1 of the readings, and the squares of (J^T W J)^-1 J^T W (x of each - x of
/// `lobe`) of the lobe, to first order. None is negative or no number.
void write_variances(const Lobe& lobe, std::span<const Lobe> one_sigma_off, const LobeBlock& block,
                     std::size_t pixels, BlockVariances& variances);

}  // namespace weft::solver
