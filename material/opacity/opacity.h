// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "material/surface.h"

// How much of a pixel is cloth: 0 a hole, 1 cloth. Seen along the camera's axis; a cloth of 0.3 mm shifts its
// lower edge by 53 um ten degrees beside it.

namespace weft::material {

/// What a LED below the cloth shows.
struct Transmission {
  /// (cloth - dark) / (bare table - dark), both frames of one exposure: 1 where nothing lies.
  View<const float> share;
  View<const std::uint8_t> saturated;  ///< not 0: the cloth's reading is clipped; may be empty
};

/// How opacity was found, and what speaks against it.
struct OpacityFacts {
  enum class Way {
    kCoverage,        ///< open holes and closed yarns were both found
    kClosedCoverage,  ///< closed yarns were; no hole is wide enough, so that open light is taken as 1
    kTransmission,    ///< cannot be found: holes or yarns are under 5 pixels wide; 1 - T itself
    kBareTable,       ///< hardly any light is held back: 1 - T itself
    kOpaque,          ///< hardly any comes through: 1 - T itself
    kMarkedHoles,     ///< no light from below: what the solver could not see
  };
  Way way = Way::kTransmission;
  double open = 1;           ///< T of an open hole: over 1 where cloth throws light back onto the diffuser
  double through_yarns = 0;  ///< T of a closed yarn, over that
  double open_share = 0;     ///< of pixels that lie level at an end of T: what both were found from
  double closed_share = 0;
  std::int64_t clipped = 0;     ///< pixels that were over 0.05 beyond 0 or 1
  std::int64_t unreadable = 0;  ///< pixels without a finite T: taken as cloth
  double mean = 1;
  std::int64_t holes = 0;  ///< of kMarkedHoles: pixels in them

  /// Whether the map is coverage of cloth, and not light that came through.
  bool is_coverage() const { return way == Way::kCoverage || way == Way::kClosedCoverage; }
};
const char* name_of(OpacityFacts::Way way);

struct Opacity {
  Image<float> map;
  OpacityFacts facts;
};

/// (1 - T / open) / (1 - through_yarns), clipped to 0 to 1. Both ends are medians of T over pixels that lie
/// level: those whose neighbours differ by no more than a twelfth of the range of T, in its upper and lower
/// third. An end counts as found from 0.5 percent of all pixels on. The sum over a mean counts in rows, so
/// the bytes depend on no thread. kBadData where over 0.1 percent of pixels are saturated, kUsage for maps of
/// other sizes or without pixels.
Result<Opacity> opacity_from_transmission(const Transmission& transmission, int threads = 0);

struct MarkedHoleOptions {
  /// Bits of the status map that a hole has: what was seen through it is black, or nothing.
  std::uint16_t bits = 0;  ///< 0: NO_SOLUTION and DARK
  int least_pixels = 25;   ///< smaller patches are pixels that failed, and no holes
};

/// Where no light comes from below: 0 in patches (of pixels that share a side) of at least so many pixels,
/// else 1.
Opacity opacity_from_status(View<const std::uint16_t> status, const MarkedHoleOptions& options = {});

/// What a solve of cloth over a table saw, less the table: albedo times normal is a sum of both by opacity,
/// so b = (b_seen - (1 - a) table (0, 0, 1)) / a. Changes slope, albedo and sigma (times 1 / a) of pixels
/// with opacity over 0.3; those below become kNoSolution. Shadows of yarns on the table are not known of.
struct TableFacts {
  std::int64_t unmixed = 0;  ///< pixels with opacity under 1 that were changed
  std::int64_t left = 0;     ///< pixels that are now NO_SOLUTION: too little cloth, or less than no light
};
inline constexpr double kLeastCloth = 0.3;  ///< opacity from which a pixel tells of the cloth
/// kUsage where the surface has no opacity, or a channel of the table's albedo is not 0 to 1.
Result<TableFacts> remove_table(Surface& surface, const std::array<double, 3>& table_albedo, int threads = 0);

struct OpacityMip {
  int level = 0;
  Image<float> map;
  double scale = 1;     ///< by which means were multiplied to keep the coverage
  double coverage = 0;  ///< share of pixels from the threshold on
};

struct OpacityMipOptions {
  bool keep_coverage = true;  ///< for an alpha test; false: means alone, for blending
  double threshold = 0.5;     ///< of the alpha test, over 0 and under 1
  int threads = 0;
};

/// Levels of width and height max(1, size >> level), level 1 to 1 x 1: means of the box that a texel covers.
/// Means close holes and thin yarns; with keep_coverage each level is multiplied by the number that leaves
/// the share of pixels from the threshold on nearest to that of the finest (Castano 2010). kUsage for a
/// threshold out of range and a map without pixels.
Result<std::vector<OpacityMip>> opacity_mips(View<const float> opacity,
                                             const OpacityMipOptions& options = {});

}  // namespace weft::material
