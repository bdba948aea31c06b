// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "solver/reflectance/lobe.h"
#include "solver/reflectance/pixel_fit.h"

namespace weft::solver {

/// Up to kRowGroup pixels side by side, as the vector kernel reads them.
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
    Lane lobe_share = {};
    Lane reading = {}, weight = {};
  };

  explicit LobeBlock(std::size_t lights) : lights_(lights) {}
  void put(std::size_t pixel, std::span<const LobeReading> readings);
  void start(std::size_t pixel, Vec3 b, double yarn);
  Vec3 b(std::size_t pixel) const;
  /// What another block of the same pixels solved of one.
  void take(std::size_t pixel, const LobeBlock& other);

  const std::vector<Light>& lights() const { return lights_; }

  Lanes3 view;
  Lanes3 solved;                  ///< b
  Lane yarn_x = {}, yarn_y = {};  ///< cosine and sine of the yarn's azimuth, from the lobe's axis
  Lane cost = {};                 ///< as of fit_pixel
  std::array<std::uint8_t, kPixels> lobe = {};  ///< by which of several; kept by take()
  Lane residual = {};                           ///< rms of reading less model, over those with a weight
  std::array<Lane, 6> normal_matrix = {};       ///< J^T W J at the solution: xx, xy, xz, yy, yz, zz

 private:
  std::vector<Light> lights_;
};

/// fit_pixel for a whole block, in float32 vectors: from `solved` on, which it leaves solved, with its cost
/// and normal matrix. No pixel's result depends on the others.
void fit_block(const Lobe& lobe, LobeBlock& block, int steps);

/// J^T W (x of `other` - x of `lobe`) of every pixel as it stands, for two lobes of one family. A cloth that
/// reflects by `other` and is solved by `lobe` has its b moved by (J^T W J)^-1 times it, to first order.
LobeBlock::Lanes3 pull_of(const Lobe& other, const Lobe& lobe, LobeBlock& block);

}  // namespace weft::solver
