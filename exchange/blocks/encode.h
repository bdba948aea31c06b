// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "exchange/blocks/block_format.h"

namespace weft::exchange {

/// The blocks of a picture, row by row from the top left, of values as the file is to hold them: sRGB or
/// linear, flipped or not, 0 to 1. What lies outside is its nearest, and what is no number is 0. `planes`
/// are R; R, G; R, G, B; or R, G, B, A, of one size: bc1 takes 3, bc3 4, bc4 1, bc5 2, bc7 3 or 4. Blocks
/// over the right and the lower border repeat the last column and row.
///
/// bc1 and the colour of bc3: range fit of libsquish. bc4, bc5 and the alpha of bc3: the better of eight
/// steps and six, refitted by least squares. bc7: mode 6, principal axis, four pairs of shared low bits,
/// least squares. Without an alpha plane the colour alone decides, and alpha decodes to 254 or 255. A block
/// of one 8-bit colour decodes to it in bc4, bc5 and, unless it holds both 0 and 255, in bc7.
///
/// The same bytes for any number of threads (0: all) and any vector unit. kUsage for other planes and a
/// picture without pixels.
Result<std::string> encode_blocks(BlockFormat format, std::span<const View<const float>> planes,
                                  int threads = 0);

/// The planes with their last column and row repeated until both sides are multiples of 4, which Direct3D
/// asks of the largest level.
Image<float> padded_to_whole_blocks(std::span<const View<const float>> planes);

}  // namespace weft::exchange
