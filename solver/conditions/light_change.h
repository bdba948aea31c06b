// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/light_field.h"
#include "core/rig/lights.h"

// How much brighter a LED was in its shot than its calibration says: from a shot that was taken again, or
// from white patches in the frame. Readings are those of core/rig/radiometry.h; what is not finite is not
// used.

namespace weft::solver {

/// Light of two shots of one LED on one block of the frame.
struct BlockChange {
  double earlier = 0;
  double later = 0;
};

/// Columns and rows of a block: many photons, and few threads of a cloth that moved.
inline constexpr int kLightBlock = 32;

/// Sums of the readings that both shots have, plane by plane.
BlockChange block_light(std::span<const View<const float>> earlier, std::span<const View<const float>> later);

/// Light of the later shot over that of the earlier, from the half of the blocks whose own ratios lie in the
/// middle: a hand in a corner of one shot changes nothing. None where no block has light in both.
std::optional<double> light_ratio(std::vector<BlockChange> blocks);

/// A LED that was lit twice.
struct LightRepeat {
  double earlier_time = 0;  ///< in any unit
  double later_time = 0;
  double ratio = 1;  ///< light_ratio()
};

/// Share of its light that a LED gains a unit of time, all LEDs alike and in a straight line: least squares
/// through the repeats. 0 without repeats.
double drift_rate(std::span<const LightRepeat> repeats);

/// Light that a patch sends back, summed over its pixels.
struct PatchLight {
  std::array<double, 3> reading_rgb = {};
  /// By the field, from a patch that lies flat at the field's cloth height.
  std::array<double, 3> predicted_rgb = {};
  std::int64_t used = 0;
  std::int64_t unusable = 0;  ///< pixels in the patch whose readings are full or missing

  /// Light read over light predicted, of all channels together.
  double factor() const;
};

/// The part of a patch that is read: its border is shared with what lies beside it.
WhitePatch well_inside(WhitePatch patch);

/// The smallest area that holds a patch and begins on a whole filter cell, inside the frame; empty where the
/// patch lies outside.
Rect area_of(const WhitePatch& patch, Size frame);

/// Light k (from 0) on the part of a patch inside `area`, from readings whose (0, 0) is the area's corner:
/// one plane is a mosaic with filters `cfa`, three are R, G, B.
PatchLight patch_light(const WhitePatch& patch, const LightField& field, std::size_t k, Rect area,
                       std::span<const View<const float>> readings, const CfaPattern& cfa);

}  // namespace weft::solver
