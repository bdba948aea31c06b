// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// Writes effects_NAME.png for every effect into `folder`, which is made: a small scene without the effect
/// and with it, and where that is little to see their difference, so many times enlarged, about middle grey.
/// A pixel of the picture is a cell of four photosites, white-balanced, in sRGB. Returns a row a picture with
/// its file, and its time over all pixels drawn; `ratio` is that over the scene without the effect.
Result<Rows> effects_gallery(const std::filesystem::path& folder, int threads);

}  // namespace weft::bench
