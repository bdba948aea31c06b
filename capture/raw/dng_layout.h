// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/raw/dng_black.h"
#include "capture/raw/tiff_tags.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::capture {

/// Counts that are not compressed, in strips or tiles.
struct PlainCounts {
  Size piece;  ///< a tile reaches beyond the sensor, a last strip may end before its height
  std::vector<std::uint64_t> at;     ///< offsets in the file, row by row
  int bits = 16;                     ///< 8 to 16
  bool is_big_endian = false;        ///< of 16 bits; fewer are packed from the highest on
  std::vector<std::uint16_t> table;  ///< of linearization; empty: none
};

/// The raw image of a DNG as its own tags describe it.
struct DngLayout {
  Size stored;                       ///< with margins
  Rect active;                       ///< the active area within `stored`
  std::optional<PlainCounts> plain;  ///< none: lossless JPEG, which LibRaw unpacks
  std::uint64_t data_at = 0;         ///< offset of the first strip, or of the list of tiles
  DngBlack black;
  float white = 0;  ///< counts
  CfaPattern cfa;   ///< of the active area's (0, 0)
  /// What the file asks a developer to do, and nobody does here: "GainMap", "WarpRectilinear (optional)".
  std::vector<std::string> opcodes;
};

/// Reads the layout. Refuses, with kBadData and `where`, what LibRaw 0.20 decodes wrongly without an error,
/// or what is damaged: data that are not what compression, bits or size say, a mosaic that is not Bayer,
/// counts that are no integers, and impossible levels. Taken are one mosaic, uncompressed in strips or tiles,
/// or as lossless JPEG in one strip or in two and more tiles. Uncompressed counts have 8 to 16 bits: 16 in
/// the file's byte order, fewer packed from the highest bit on, each row from a new byte. A black level that
/// is not said is 0; a white level that is not said is what the largest code stands for, 2^bits - 1 or the
/// end of the linearization table. (Adobe, Digital Negative Specification 1.4, 2012; TIFF revision 6.0,
/// 1992.)
Result<DngLayout> read_dng_layout(const Tiff& tiff, std::uint64_t file_bytes, const std::string& where);

}  // namespace weft::capture
