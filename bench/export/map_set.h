// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/export/solved_cloth.h"
#include "core/image.h"
#include "core/result.h"

namespace weft::bench {

/// Writes a set of maps of this size into `folder`: the solved cloth beside itself over and over, with a
/// height, an openness and a roughness that vary as its normals do. Errors of write_image().
Result<void> write_map_set(const SolvedCloth& cloth, Size size, double mm_per_pixel,
                           const std::filesystem::path& folder);

}  // namespace weft::bench
