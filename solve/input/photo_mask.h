// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/result.h"
#include "core/image/image.h"

// Which pixels of photographs are cloth, as somebody painted it.

namespace weft::solve {

/// Whether a picture is called mask, or NAME.mask, NAME_mask or NAME-mask, in capitals or not.
bool is_mask_name(const std::filesystem::path& file);

/// The picture in the folder that has such a name and any format that photographs have; empty where there is
/// none. kBadData where there are several.
Result<std::filesystem::path> find_mask(const std::filesystem::path& folder);

/// 1 where cloth is, of photographs of this size: where the brightest colour is over one half, and so is the
/// alpha, if there is one. Where all have one colour, alpha alone tells. A mask of the counts 0 and 1 is
/// taken for one of black and white. It is turned by its own orientation first. kBadData where the size is
/// another, where no pixel is left, and where nothing is over one half although there is more than black.
Result<Image<std::uint8_t>> read_mask(const std::filesystem::path& file, Size size, int orientation);

}  // namespace weft::solve
