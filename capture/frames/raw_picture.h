// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

namespace weft::capture {

/// A mosaic as a linear picture of half its size: planes R, G, B of v = (count - black) / (white - black),
/// linearised, without the veil of a lens whose veil is known; each pixel is a cell of the filter pattern,
/// full (+infinity) where a photosite of the channel is. An odd last row or column is left out.
Image<float> half_size_picture(const RawFrame& frame, const Response& response);

}  // namespace weft::capture
