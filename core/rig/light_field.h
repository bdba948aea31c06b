// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"

namespace weft {

/// Light matrices with this condition number or more are flagged.
inline constexpr double kIllConditionedFrom = 1e6;

/// How every light falls on the cloth seen by every pixel.
///
/// A reading is  r_kc = rho_c * e_kc * max(0, n . l_k)  with, for a near light,
/// e_kc = Phi_kc * g_kc * max(0, -l_k . aim_k)^mu_k / d_k^2.  Directions and distances follow from the
/// pixel's point on the cloth, which is interpolated bilinearly between points every kCell pixels (under 0.01
/// pixel off for any lens a scanner would use); gains likewise. Nothing is stored per pixel.
class LightField {
 public:
  /// Pixels from one grid point to the next.
  static constexpr int kCell = 16;

  /// `camera` is needed for near lights only. Fails with kBadData where lights cannot work: fewer than three,
  /// a LED at or below the cloth, or directions of rank below three (condition over 1e6) at the centre or a
  /// corner.
  static Result<LightField> make(Lights lights, const std::optional<CameraModel>& camera, Size size,
                                 double cloth_height_mm);

  struct Light {
    Vec3 direction;       ///< l: unit, from the cloth to the light
    double strength = 0;  ///< e: reading of a white surface that faces the light; 0 behind the LED
  };
  /// Light k (from 0) as channel c (0 red, 1 green, 2 blue) sees it at a pixel, or at a point of the grid up
  /// to the first right of the frame or below it.
  Light at(std::size_t k, int c, int x, int y) const;

  /// A stretch of grid line blended down to a pixel row: the value at the left end of each cell and its
  /// step a pixel.
  struct RowLine {
    std::vector<float> value;
    std::vector<float> step;
  };
  struct Row {
    RowLine x_mm, y_mm;
    std::array<RowLine, 3> gain_rgb;  ///< empty where has_gain() is false
    std::vector<RowLine> led_gain;    ///< one a LED; empty where has_gain() is false
  };
  /// What the kernels read of pixels x0 <= x < x1 of row y, from the cell that begins at x0, a multiple of
  /// kCell. `row` keeps its memory from call to call.
  void read_row(int y, int x0, int x1, Row& row) const;

  const Lights& lights() const { return lights_; }
  std::size_t count() const { return light_count(lights_); }
  double cloth_height_mm() const { return cloth_height_mm_; }
  bool has_gain() const { return !gain_rgb_[0].empty(); }

 private:
  using Grid = std::vector<double>;
  double sample(const Grid& grid, int x, int y) const;
  void blend(const Grid& grid, int y, int first_cell, int cells, RowLine& line) const;

  Lights lights_;
  double cloth_height_mm_ = 0;
  int columns_ = 0;  ///< grid points a line
  Grid x_mm_, y_mm_;
  std::array<Grid, 3> gain_rgb_;
  std::vector<Grid> led_gain_;
};

/// Condition number of the matrix whose rows are the given directions, infinity where its rank is below
/// three.
double condition_number(const std::vector<Vec3>& directions);

}  // namespace weft
