// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/result.h"

// Smaller levels of a texture. Roughness that follows the normals beneath is
// material/filtering/roughness_mips.

namespace weft::material {

/// How texels become one.
enum class MipMean {
  kPlain,  ///< values themselves: data, and colour that is linear
  kSrgb,  ///< linear light of values that have the transfer function of sRGB, 0 to 1; a fourth plane is plain
  kNormal,  ///< slopes, up to 20 (87 degrees), of unit normals x, y, z; unit length again
};
const char* name_of(MipMean mean);
std::optional<MipMean> mip_mean_named(std::string_view name);

/// The level after `planes` (1 to 4; 3 or 4 for kSrgb, 3 for kNormal): sides max(1, side / 2), rounded down.
/// A texel is the box that it covers, of texels that it cuts by their share, so that odd sides lose no
/// border. What is no number is left out; where all is, a mean is 0 and a normal (0, 0, 1). The same bytes
/// for any number of threads. kUsage for planes of several sizes, too few, too many or without pixels.
Result<Image<float>> next_mip(std::span<const View<const float>> planes, MipMean mean, int threads = 0);

/// Levels 1, 2 ... down to 1 x 1, or `most` of them; none of a single texel.
Result<std::vector<Image<float>>> mip_chain(std::span<const View<const float>> planes, MipMean mean,
                                            int threads = 0, int most = 32);

}  // namespace weft::material
