// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "bench/cloths/drawn_kinds.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "solve/input/photo_input.h"
#include "solve/input/session_input.h"

namespace weft::bench {

/// What is written of a cloth, and the normals that a solve of it should find: planes X, Y, Z.
struct WrittenPhotographs {
  solve::PhotoOptions input;
  Image<float> normal;
};

/// Photographs under distant lights with the noise of 40 000 electrons at full scale, EXR, and cloth.lp with
/// their directions and strengths, all of them times one factor that nobody tells.
Result<WrittenPhotographs> write_photographs(const KindOfCloth& cloth, Size size, std::uint32_t seed,
                                             const std::filesystem::path& folder, int threads);

}  // namespace weft::bench
