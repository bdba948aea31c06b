// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "capture/raw/tiff_tags.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::capture {

/// The raw image of a DNG as its own tags describe it.
struct DngLayout {
  Size stored;                                     ///< with margins
  Rect active;                                     ///< the active area within `stored`
  std::uint64_t data_at = 0;                       ///< offset of the first strip, or of the list of tiles
  std::array<std::array<float, 2>, 2> black = {};  ///< counts, [y & 1][x & 1] on the active area
  float white = 0;                                 ///< counts
  CfaPattern cfa;                                  ///< of the active area's (0, 0)
};

/// Reads the layout. Refuses, with kBadData and `where`, what LibRaw 0.20 decodes wrongly without an error:
/// data that are not what compression, bits or size say, strips and tiles it does not follow, a mosaic that
/// is not Bayer, counts that are no integers, and levels that are missing, impossible or not the same in
/// every cell. Taken are one mosaic, uncompressed in strips that follow one another, or as lossless JPEG in
/// one strip or in two and more tiles. Uncompressed counts have 8 to 16 bits: 16 in the file's byte order,
/// fewer packed from the highest bit on, each row from a new byte. A linearization table is applied. (Adobe,
/// Digital Negative Specification 1.4, 2012; TIFF revision 6.0, 1992.)
Result<DngLayout> read_dng_layout(const Tiff& tiff, std::uint64_t file_bytes, const std::string& where);

}  // namespace weft::capture
