// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::calibration {

/// Side of the squares, in photosites, over which frames are averaged to measure a sensor.
inline constexpr int kResponseBlock = 32;

/// Means of v = (count - black) / (white - black) and of its powers over the photosites of one channel in one
/// square, with the levels that the file names. Powers are averaged photosite by photosite, so that a curve
/// in v is exact over a textured square.
struct Moments {
  double v = 0, v2 = 0, v3 = 0;
  double photosites = 0;  ///< times frames; 0 where one of them was full or stood at count 0
};

/// What a frame, or several alike, recorded, square by square.
struct BlockLight {
  int frames = 0;
  Size grid;
  std::vector<std::array<Moments, 3>> blocks;  ///< row by row; red, green (both), blue
  std::array<double, 3> full_share = {};       ///< of photosites from kSaturatedFrom on, mean over frames
  double zero_share = 0;                       ///< of photosites at count 0

  /// Mean of v over all squares, whatever they hold: how bright a frame is.
  std::array<double, 3> mean = {};
};

/// `bad` marks photosites not to use (not 0), or is empty. Rows and columns that do not fill a square are
/// left out.
BlockLight block_light(const RawFrame& frame, View<const std::uint8_t> bad);

/// Joins one more frame of the same light and exposure into `sum`, which may be empty.
void join(BlockLight& sum, const BlockLight& frame);

/// Moments of v - offset.
Moments shifted(const Moments& moments, double offset);

}  // namespace weft::calibration
