// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace weft::bench {

inline constexpr std::array<const char*, 2> kWideLayers = {"normal", "albedo"};
/// The call for the solve of write_wide_solve().
inline constexpr const char* kWideSolve = "/api/v1/sessions/wide/solves/0123456789abcdef";

/// Three by two.
Size wide_size(int megapixels);
/// A session with one solve, as far as a viewer looks: normals and albedo that no codec can guess.
Result<void> write_wide_solve(const std::filesystem::path& sessions, Size size);
/// The call for one of its tiles: normals raw, albedo as JPEG.
std::string wide_tile(const std::string& layer, int level, int column, int row);
/// Calls for tiles of levels 0 to 2 anywhere in it, of both layers in turn.
std::vector<std::string> wide_tiles(Size size, int count, std::uint64_t seed);

}  // namespace weft::bench
