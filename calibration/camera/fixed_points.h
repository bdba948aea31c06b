// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "calibration/camera/pose.h"
#include "core/image/image.h"
#include "core/rig/camera.h"
#include "core/rig/fixed_point.h"

// What stays where it is beside a sheet or a cloth, found by its picture. Pictures are of cells, of several
// photosites of all colours each, summed over frames under all LEDs: who lit them does not matter then.

namespace weft::calibration {

/// Side of a cell, in pixels: even, so that a cell has all colours of a mosaic; at most 1640 cells a side.
int point_cell_px(Size frame);

/// How far a camera that was knocked by 5 mm may show a point from where it was, in cells. A knock turns a
/// camera as well: 8 mm on the table.
int point_reach_cells(const CameraModel& camera, int cell_px);

/// Adds what each whole cell of `part` holds, times `weight`. What is not finite is black.
template <typename T>
void add_cells(View<T> picture, Rect part, int cell_px, float weight, Image<float>& cells) {
  for (int y = 0; y < cells.height() * cell_px; ++y) {
    const T* from = picture.row(part.y0 + y) + part.x0;
    float* to = cells.plane().row(y / cell_px);
    for (int x = 0; x < cells.width() * cell_px; ++x) {
      const auto value = static_cast<float>(from[x]);
      if (std::isfinite(value)) to[x / cell_px] += weight * value;
    }
  }
}
/// As many whole cells as `part` has.
inline Size cells_in(Rect part, int cell_px) {
  return {part.width() / cell_px, part.height() / cell_px};
}

/// Where a point is to be looked for: its own place and `reach` cells around it, as far as the frame goes,
/// from a corner that is a cell's. Empty where the frame ends before.
Rect search_box(const FixedPoint& point, int reach, Size frame);

/// A point in a picture.
struct PointSighting {
  std::string id;
  double x_px = 0, y_px = 0;
  double sigma_px = 0;
};

/// The point in the cells of a box by zero-mean normalized cross-correlation, its peak to parts of a cell by
/// a parabola, its sigma from the peak's curvature and from what differs (least squares, white noise).
/// Nothing where no place looks like it to 0.8, where two do, or where the best one is at the border.
std::optional<PointSighting> find_point(const FixedPoint& point, const Image<float>& cells, Rect box);

/// Finds points in pictures of a rig on which only a sheet is moved.
class FixedPointFinder {
 public:
  /// Points of `known` that are still there keep their ids.
  FixedPointFinder(const CameraModel& camera, std::vector<FixedPoint> known);
  ~FixedPointFinder();
  FixedPointFinder(FixedPointFinder&&) noexcept;

  /// The cells of a whole frame, and the corners of the sheet in it, one after the other around it. What the
  /// sheet covers is not looked at.
  void add(const Image<float>& cells, std::span<const PixelPoint> sheet);

  /// Points that looked alike and stood still in most of at least two pictures that showed them, with nothing
  /// like them within reach: at most 24, spread over the frame.
  std::vector<FixedPoint> found() const;

 private:
  struct Candidate;
  void look_for_known(const Image<float>& cells, std::span<const PixelPoint> sheet);
  void look_for_new(const Image<float>& cells, std::span<const PixelPoint> sheet);

  Size frame_;
  int cell_px_, reach_;
  std::vector<FixedPoint> known_;  ///< not seen yet
  std::vector<Candidate> candidates_;
};

}  // namespace weft::calibration
