// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/image_io/image_io.h"

namespace weft::material {

inline constexpr Size kSmall = {40, 28};

/// What a channel of a map holds at a pixel.
using PixelOf = std::function<double(int x, int y, int channel)>;

/// A map of that size.
void write_small(const std::filesystem::path& file, const std::vector<std::string>& channels,
                 const PixelOf& at, const WriteOptions& options = {});

/// Smooth maps in closed form, as all presets ask for them.
double small_albedo(int x, int y, int channel);
std::array<double, 3> small_normal(int x, int y);
double small_height_mm(int x, int y);  ///< from -0.145 to 0.062
double small_openness(int x, int y);
double small_alpha(int x, int y);
double small_f0(int x, int y);

/// What of a set is one number in place of the above.
struct SmallSet {
  bool is_rough_alike = false, is_f0_alike = false, is_albedo_alike = false;
  std::string name = "cloth";

  /// A folder as weft maps leaves one.
  void write(const std::filesystem::path& folder) const;
};
inline constexpr double kSmallF0 = 0.0484, kSmallAlpha = 0.36;
inline constexpr std::array<double, 3> kSmallAlbedo = {0.22, 0.24, 0.32};

/// Exports the set at `folder` to OUTPUT/PRESET, which it returns.
std::filesystem::path exported_small(const std::filesystem::path& folder, const std::string& preset,
                                     const std::filesystem::path& output);

}  // namespace weft::material
