// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"
#include "core/vec.h"
#include "solver/reflectance/pixel_fit.h"

namespace weft::solver {
class Method;
}

namespace weft::pipeline {

class LightCorrection;
struct Photographs;

/// At most so many pixels of a pose are fitted: more say nothing of a lobe that model error does not drown.
inline constexpr std::size_t kGlossPixels = 4000;

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
  /// Of one channel of RGB.
  std::span<const solver::LobeReading> of_plane(std::size_t plane, std::size_t pixel) const {
    return {planes[plane].data() + pixel * each(), each()};
  }
};

/// At most kGlossPixels of the sample tiles (solver/sample_tiles.h), from where `base` solves them. Pixels
/// that follow each other are far apart in the frame, so that the first of them stand for all. Readings go
/// through the correction, if there is one. Errors: of the correction.
Result<GlossSamples> sample_gloss(const Photographs& photographs, const solver::Method& base,
                                  LightCorrection* correction, int threads);

/// The same pixels with the readings of these LEDs, in this order; of one that is not there none counts.
GlossSamples by_leds(const GlossSamples& samples, std::span<const int> leds);

}  // namespace weft::pipeline
