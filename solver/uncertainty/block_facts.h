// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "solver/uncertainty/model_sigma.h"

// What a block of a solved frame shows of how far its normals may be off, beside what formulas make of it.

namespace weft::solver {

/// Shares, slopes, and natural logarithms of what has a unit.
enum BlockFact : std::size_t {
  kLogModel,            ///< of the rms angle that model_angles() gives, degrees
  kLogNoise,            ///< of the rms angle by noise, degrees
  kSlope,               ///< rms
  kLogMisfit,           ///< of the rms residual over the albedo
  kMisfitPeaks,         ///< of mean square over squared mean of the squared residuals
  kAlbedo,              ///< mean, up to kMostFactAlbedo; if relative
  kAlbedoVaries,        ///< standard deviation over mean
  kAlbedoFollowsSlope,  ///< correlation of the albedo with the squared slope
  kLogBend,             ///< of the rms change of slopes from pixel to pixel
  kLogCurl,             ///< of the rms curl of slopes over that
  kLogCurlOfNoise,      ///< the same as noise alone would make it
  kSpecularShare,       ///< of the pixels
  kShadowedShare,       ///< likewise
  kRobustShare,         ///< of the block
  kOfHalf,              ///< 1: a preview
  kOfFast,              ///< 1: without regard to shadows
  kBouncesOut,          ///< 1: light from the cloth was taken out
  kLobeShare,           ///< of the frame's blocks
  kLogLobeMisfit,       ///< of the chi-square that the best lobe leaves; 0 where none was sought
  kSigmaSlope,          ///< of ModelTraits
  kLogUnpredicted,      ///< of left-out light, over what noise makes of it
  kLogTurned,           ///< of the jackknife's sigma of normals, degrees
  kBlockFacts
};
using BlockFacts = std::array<float, kBlockFacts>;
inline constexpr float kMostFactAlbedo = 1.2F;

/// A row of a block, and the normals of the row below.
struct BlockRow {
  std::array<const float*, 3> normal, below;
  const float *residual, *albedo, *noise_deg, *model_deg;
  const std::uint16_t* status;
};

/// Adds up what a block's facts are made of.
class BlockSums {
 public:
  /// Takes in the first of `count` pixels and every second after it, in a mosaic's row all of one channel, as
  /// those of all rows that are added should be.
  void add(const BlockRow& row, int count);
  BlockFacts facts(const ModelTraits& traits, float robust) const;

 private:
  double pixels_ = 0, pairs_ = 0;
  double model2_ = 0, noise2_ = 0, pair_noise2_ = 0, residual2_ = 0, residual4_ = 0, bend2_ = 0, curl2_ = 0;
  double specular_ = 0, shadowed_ = 0;
  double albedo_ = 0, albedo2_ = 0, slope2_ = 0, slope4_ = 0, albedo_slope2_ = 0;
};

}  // namespace weft::solver
