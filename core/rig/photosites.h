// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft {

// Photosites that say nothing of light: hot ones, whose own dark current drowns it, and dead ones. They are
// found against their four nearest neighbours of the same filter, two columns or rows away, so that a colour,
// a vignette or a warm corner is no fault.

/// A photosite of the active area; in order of rows.
struct Photosite {
  int y = 0;
  int x = 0;
  friend auto operator<=>(const Photosite&, const Photosite&) = default;
};

/// A hot photosite stands out of the dark shot by both of these: by so many sigmas above the middle of its
/// neighbours, where sigma is that of all photosites of the frame (from the median absolute deviation),
inline constexpr double kHotFrom_sigmas = 8;
/// and by so large a share of the way from black to white. A weaker one is kept: the dark shot is subtracted
/// from it, which adds some noise. On a weave that costs far less than a value from its neighbours.
inline constexpr double kHotFromShare = 0.1;
/// A photosite is dead where every bright shot has it below this share of its darkest neighbour.
inline constexpr double kDeadBelow = 0.05;
/// A shot is bright there where the darkest neighbour stands this many sigmas out of the read noise.
inline constexpr double kBrightFrom_sigmas = 20;

/// The hot photosites of a dark shot. `read_noise_counts` is the least that sigma can be.
std::vector<Photosite> hot_photosites(const RawFrame& dark, double read_noise_counts, int threads);

/// The dead photosites of at least three lit frames, all of one size: those that a bright shot at least three
/// times, and no bright shot ever otherwise, has near black. `dark` may be null.
std::vector<Photosite> dead_photosites(std::span<const RawFrame> lit, const RawFrame* dark,
                                       double read_noise_counts, int threads);

/// Gives each photosite of `bad`, which is sorted, what its nearest good neighbours of the same filter say,
/// in each of the frames of a session: the mean of those beside it and of those above and below, weighted
/// against the square of how far the two of a pair differ, summed over all frames, so that a yarn is
/// continued along itself. Full where one of them is full. Beside borders and other bad ones, the mean of
/// those that are good; with none within 16 columns and rows it stays.
void replace_photosites(std::span<RawFrame* const> frames, std::span<const Photosite> bad, int threads);

}  // namespace weft
