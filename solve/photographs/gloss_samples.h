// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec.h"
#include "solver/reflectance/pixel_fit.h"

namespace weft::solve {

/// Pixels of one cloth and where a solve left them: what a lobe is sought in.
struct GlossSamples {
  std::vector<int> leds;                      ///< of the readings of a state, in their order
  std::size_t states = 1;                     ///< of films
  std::vector<solver::LobeReading> readings;  ///< as many of each pixel: all of one state after the other's
  std::array<std::vector<solver::LobeReading>, 3> planes;  ///< of RGB those of each channel; else empty
  std::vector<Vec3> start;                                 ///< albedo times normal
  std::vector<std::size_t> part;                           ///< quarter of the frame, row by row

  std::size_t pixels() const { return start.size(); }
  std::size_t each() const { return readings.size() / start.size(); }
  std::span<const solver::LobeReading> of(std::size_t pixel) const {
    return {readings.data() + pixel * each(), each()};
  }
  /// A pixel's readings in one channel of RGB.
  std::span<const solver::LobeReading> of_plane(std::size_t plane, std::size_t pixel) const {
    return {planes[plane].data() + pixel * each(), each()};
  }
};

}  // namespace weft::solve
