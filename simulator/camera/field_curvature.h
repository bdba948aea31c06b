// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/image/color_spaces.h"
#include "core/image/image.h"
#include "core/rig/camera.h"
#include "simulator/camera/camera_settings.h"
#include "simulator/camera/optics.h"

namespace weft::simulator {

/// The widest disc that a pixel of such a lens gathers light by.
BlurKernel widest_disc(const FieldSettings& settings);

/// Blur by the disc of a lens that is in focus on a bowl: its diameter grows with the square of the distance
/// from the optical axis.
class FieldCurvature {
 public:
  FieldCurvature(const FieldSettings& settings, const CameraModel& camera);

  /// The disc's diameter grows no more beyond the frame's farthest corner.
  double diameter_px(double x, double y) const;
  /// Pixels that light comes from beyond those that are filled.
  int radius() const { return discs_.back().radius; }

  /// Fills `out`, by rows of `out_rect`, from `in` on a rectangle that holds `out_rect` grown by radius().
  /// A pixel gathers light by its own disc, whose weights are interpolated between those of diameters 1/32
  /// pixel apart.
  void blur(std::span<const Rgb> in, Rect in_rect, Rect out_rect, std::span<Rgb> out) const;

 private:
  double cx_, cy_, corner_px_, largest_px_;
  std::vector<BlurKernel> discs_;  ///< of diameters 0, 1/32, 2/32 pixel and so on
};

}  // namespace weft::simulator
