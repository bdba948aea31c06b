// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/image/raw_frame.h"

// Where readings stop: a sensor, its converter or whoever developed a photograph gives all light beyond it
// one value. No light makes many samples equal by itself: their noise spreads them, so that a value just
// below is as frequent as the largest.

namespace weft {

/// How often each level occurs near the top of a photograph.
struct TopTally {
  std::uint32_t first = 0;            ///< level of counts[0]
  std::vector<std::uint32_t> counts;  ///< of `first` and those above it, up to the highest that occurs
  std::int64_t samples = 0;           ///< of the photograph
};

struct StopRules {
  double widest = 0;  ///< share of the level that a pile's levels may scatter over; 0: one level
  double most_of_one =
      1;           ///< of a photograph's samples: where one has more at the pile it is a surface's value
  int fewest = 2;  ///< photographs that have a pile there
};

/// Rules for counts. Photons scatter a sensor's own readings by more than `widest` below a quarter of a
/// million electrons (3 sigma), so a smooth white surface is no pile.
inline constexpr StopRules kCountsStop = {1.0 / 256, 1};

/// The level at which photographs stop: enough of them have a pile there, over three times what as many
/// levels hold anywhere else in their top fifth, and next to nothing above it (1 percent of the pile, as hot
/// photosites). The lowest level that all but a hundredth of the pile reaches.
std::optional<double> find_stop(std::span<const TopTally> photographs, const StopRules& rules);

/// The tallies of red, green (both) and blue of a mosaic. Of a large one every so many rows of cells are
/// looked at.
std::array<TopTally, 3> top_tallies(const RawFrame& frame);

/// find_stop() of each channel of some mosaics; 0 where they stop nowhere, or within 5 percent of black.
std::array<float, 3> find_count_stops(std::span<const std::array<TopTally, 3>> mosaics, const RawFrame& like);

/// The same of one mosaic, for who meters and cannot wait for another: where a single count piles up, below
/// what is taken to be full by the file's white (kSaturatedFrom).
std::array<float, 3> find_count_stops(const RawFrame& frame);

}  // namespace weft
