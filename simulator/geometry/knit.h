// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/vec.h"
#include "simulator/geometry/geometry_settings.h"
#include "simulator/geometry/surface_point.h"

namespace weft::simulator {

/// Whether the loops are neither so tall nor so wide that they reach past the neighbours that Knit looks at:
/// a course of half a wale to two wales.
bool loops_reach_their_neighbours_only(const GeometrySettings& geometry);

/// Plain (stocking) stitch seen from its face: each course is one yarn along x whose loops hang in those of
/// the course below, their legs in front as columns of V, their heads and feet behind. A loop's axis is
///   x = wale (t / 2 pi + a sin 2t),  y = -b course cos t,  z = -c d (1 + cos 2t) - d / 2,  0 <= t <= 2 pi,
/// with the yarn's diameter d: a smooth curve of our own after the loops of Peirce (1947) and of Demiroz and
/// Dias (2000), without their contact of yarns. The surface is the highest yarn at each point, as swept by a
/// ball along the axis that is round down to slopes of loop_flank_deg and straight beyond: so the height
/// never jumps and no slope exceeds tan(loop_flank_deg). Height 0 is the crest of the legs.
class Knit {
 public:
  explicit Knit(const GeometrySettings& geometry);
  SurfacePoint at(double x_mm, double y_mm) const;
  HeightRange heights_mm(const Area& = {}) const { return {lowest_mm_, 0}; }
  std::optional<Period> period_mm() const { return Period{wale_mm_, course_mm_}; }
  double steepest_slope() const { return flank_slope_; }

 private:
  /// A stretch of an axis that may be on top somewhere in a cell of the period.
  struct Stretch {
    int course;  ///< of the axis, relative to the cell's
    int step;    ///< t is from step to step + 1 times kStep
  };
  struct AxisPoint {
    Vec3 mm;
    Vec3 by_t;
  };
  /// The ball at a point of the axis, as seen at a point of the table.
  struct Ball {
    double height_mm;
    double by_t;
    double slope_x, slope_y;
  };

  AxisPoint axis_at(double t) const;
  AxisPoint axis_at_step(const Stretch& stretch, int end) const;
  Ball ball_at(const AxisPoint& axis, double x_mm, double y_mm) const;
  AxisPoint crest_in(const Stretch& stretch, double rise0, double rise1, double x_mm, double y_mm) const;
  std::vector<Stretch> stretches_of_cell(int column, int row);

  static constexpr int kSteps = 64;  ///< a loop
  static constexpr int kCells = 24;  ///< a period, in both directions
  static constexpr double kStep = 2 * kPi / kSteps;

  double wale_mm_;
  double course_mm_;
  double radius_mm_;
  double round_mm_;  ///< from the axis to where the ball stops being round
  double flank_slope_;
  double lowest_mm_ = 0;
  std::vector<AxisPoint> steps_;             ///< of one loop
  std::vector<std::vector<Stretch>> cells_;  ///< [row * kCells + column]
};

}  // namespace weft::simulator
