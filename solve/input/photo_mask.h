// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

// Pictures that lie beside photographs and are none under a lamp: which pixels are cloth, as somebody painted
// it, and what the camera sees with all lamps off.

namespace weft::solve {

/// Whether a picture is called mask, or NAME.mask, NAME_mask or NAME-mask, in capitals or not.
bool is_mask_name(const std::filesystem::path& file);

/// The picture in the folder that has such a name and any format that photographs have; empty where there is
/// none. kBadData where there are several.
Result<std::filesystem::path> find_mask(const std::filesystem::path& folder);

/// Whether a picture is called dark or ambient, or NAME.dark, NAME_dark or NAME-dark and so on, in capitals
/// or not.
bool is_dark_name(const std::filesystem::path& file);

/// The pictures in the folder that have such a name, sorted.
std::vector<std::filesystem::path> find_dark(const std::filesystem::path& folder);

/// 1 where cloth is, of photographs of this size: where the brightest colour is over one half, and so is the
/// alpha, if there is one. Where all have one colour, alpha alone tells. A mask of the counts 0 and 1 is
/// taken for one of black and white. It is turned by its own orientation first. kBadData where the size is
/// another, where no pixel is left, and where nothing is over one half although there is more than black.
Result<Image<std::uint8_t>> read_mask(const std::filesystem::path& file, Size size, int orientation);

}  // namespace weft::solve
