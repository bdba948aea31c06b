// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/image/color_spaces.h"
#include "simulator/targets/target_settings.h"

// What is printed: upright rectangles of one ink each. Boards, charts, scales and markers are all such, so
// that the mean over a pixel is exact and no bitmap is sampled.

namespace weft::simulator {

/// Inks by number; patches of scales and charts follow.
inline constexpr int kWhiteInk = 0;
inline constexpr int kBlackInk = 1;
inline constexpr int kFirstPatchInk = 2;

/// A place on a target and what a pixel sees around it: u to the right and v up from its centre in its plane,
/// a box with sides along u and v.
struct TargetSpot {
  double u_mm = 0;
  double v_mm = 0;
  double width_mm = 0;   ///< of the box along u; 0 is a point
  double height_mm = 0;  ///< along v
};

/// A part of a sheet in one ink.
struct Rectangle {
  double u0_mm, v0_mm, u1_mm, v1_mm;  ///< u0 < u1, v0 < v1
  int ink = kWhiteInk;
};

/// What is printed on a sheet, as rectangles on a grid of cells.
class Pattern {
 public:
  /// The first rectangle is the whole sheet; later ones cover earlier ones and stay inside it.
  explicit Pattern(std::span<const Rectangle> rectangles);

  double width_mm() const { return u_.back() - u_.front(); }
  double height_mm() const { return v_.back() - v_.front(); }

  /// The ink at a point; beyond the sheet the nearest one.
  int ink_at(double u_mm, double v_mm) const;
  /// Share of the spot's box that lies on the sheet; 1 or 0 for a point.
  double coverage(const TargetSpot& spot) const;
  /// Mean over what the spot's box covers of the sheet, exact; beyond the sheet the nearest ink's. An ink
  /// beyond the end of `albedo_of_ink` reflects nothing.
  Rgb average(const TargetSpot& spot, std::span<const Rgb> albedo_of_ink) const;

 private:
  std::vector<double> u_;  ///< edges of the columns, rising
  std::vector<double> v_;  ///< edges of the rows, rising
  std::vector<int> inks_;  ///< rows of cells from the bottom
};

/// Lays the pattern out around its centre. kBadData names a setting that is out of its range, a dictionary
/// that does not exist or has too few markers.
Result<Pattern> make_pattern(const PatternSettings& settings);

}  // namespace weft::simulator
