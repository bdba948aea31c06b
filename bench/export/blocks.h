// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/export/parts.h"

namespace weft::bench {

/// Loss and price of each block format on the cloth of a scene as the level standard solves it. `psnr_db` is
/// of what is decoded against the values in float that were encoded, colour as sRGB; `psnr_8bit_db` against
/// the same in 8 bits. Angles are of normals whose z is the rest of x and y, against the solved ones. `mp_s`
/// is megapixels a processor second of one thread; `s_16mp` the wall time of 16 megapixels of that cloth,
/// laid side by side, on two threads; `copies` that time over a copy of the same bytes on two threads, `bc1s`
/// over that of bc1, which is libsquish's.
Result<Rows> export_blocks(const ExportBenchOptions& options);

}  // namespace weft::bench
