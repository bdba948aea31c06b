// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/image/color_spaces.h"
#include "core/image/image.h"
#include "core/rig/camera.h"
#include "simulator/camera/camera_settings.h"

namespace weft::simulator {

/// Red and blue as a lens shows them at another scale than green, about its optical axis.
class LateralColour {
 public:
  LateralColour(const ChromaticSettings& settings, const CameraModel& camera);

  /// How much farther right (or down) than a green photosite at that column (row) one of channel c looks;
  /// beyond the frame's corner it grows no more.
  double shift_x_px(std::size_t c, double x) const { return shift(c, x - cx_); }
  double shift_y_px(std::size_t c, double y) const { return shift(c, y - cy_); }
  /// Pixels that are looked at beyond those that are filled.
  int reach() const { return reach_; }

  /// Fills `out`, by rows of `out_rect`, from `in` on a rectangle that holds `out_rect` grown by reach().
  /// Red and blue are found between the pixels by cubic convolution (Keys 1981), within the range of the
  /// sixteen that it weighs.
  void image(std::span<const Rgb> in, Rect in_rect, Rect out_rect, std::span<Rgb> out) const;

 private:
  double shift(std::size_t c, double from_axis_px) const;

  double cx_, cy_;
  double corner_px_;                    ///< from the axis to the farthest corner of the frame
  std::array<double, 3> at_corner_px_;  ///< by channel
  int reach_;
};

}  // namespace weft::simulator
