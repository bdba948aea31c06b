// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "solve/files/normal_comparison.h"

namespace weft::material {

/// Relative differences of two albedo maps over R, G, B of the pixels that count.
struct AlbedoComparison {
  std::int64_t pixels = 0;
  double mean_rel = 0;  ///< mean of |A - B| / B
  double bias_rel = 0;  ///< mean of (A - B) / B
};

/// Differences of one channel that both maps have, in its own unit.
struct NumberComparison {
  std::string name = {}, unit = {};  ///< "height", "mm"; empty: nobody says
  std::int64_t pixels = 0;
  double mean_abs = 0, bias = 0, max_abs = 0;
};

enum class ComparedKind { kNormal, kAlbedo, kNumber };
using MapComparison = std::variant<solve::NormalComparison, AlbedoComparison, std::vector<NumberComparison>>;

/// Compares `tested` with `truth`, of equal size, as what they are (material/read/file_meaning.h): normals by
/// names of channels, an export.json or unit lengths, colours by those, by tags of the format or by the
/// file's name. A pixel counts if it is inside the mask (over one half; empty: all), finite in both maps,
/// not called unsolved by the status.png of a solve that a map lies in and, of normals and colours, not all 0
/// in the truth. Normals may be packed as n / 2 + 1/2 and lack z; a DirectX
/// map that an export.json lists is turned. kUsage where nothing tells what a map is, or they are of two
/// kinds, and `kind` is not said; kBadData for other sizes and for what is not such a map.
Result<MapComparison> compare_maps(const std::filesystem::path& tested, const std::filesystem::path& truth,
                                   const std::filesystem::path& mask, std::optional<ComparedKind> kind = {});
/// The same of maps that are known to be normals, or albedo.
Result<solve::NormalComparison> compare_normals(const std::filesystem::path& tested,
                                                const std::filesystem::path& truth,
                                                const std::filesystem::path& mask);
Result<AlbedoComparison> compare_albedo(const std::filesystem::path& tested,
                                        const std::filesystem::path& truth,
                                        const std::filesystem::path& mask);

}  // namespace weft::material
