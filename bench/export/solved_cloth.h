// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/image.h"
#include "core/result.h"

namespace weft::bench {

/// A cloth as a scan of it has it, with its noise.
struct SolvedCloth {
  Image<float> normal;  ///< X, Y, Z
  Image<float> albedo;  ///< R, G, B, linear
  double mean_tilt_deg = 0;
};

/// The middle of a scene's frame, `most` at most, photographed and solved by the level standard. Errors:
/// those of read_scene(), rendering and solving.
Result<SolvedCloth> solved_cloth(const std::filesystem::path& scene, Size most, int threads);

}  // namespace weft::bench
