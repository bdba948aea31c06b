// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/camera.h"
#include "core/rig/lateral_color.h"
#include "solve/bands/bands.h"
#include "solve/bands/held_rows.h"
#include "solver/lateral/align.h"

namespace weft::solve {

/// Takes the bands of a solved mosaic in order and hands them on with the maps of red and blue photosites
/// where those of green are (solver/lateral): albedo is demosaiced again from what then lies side by side.
/// The model's sigma stays where it is. What leaves it lags behind; its maps begin and end together.
class Realign {
 public:
  /// `next` must outlive it.
  Realign(Size size, const CfaPattern& cfa, const LateralColor& lateral, const CameraModel& camera,
          int threads, const BandSink& next);

  Result<void> put(const MapBand& band);

 private:
  Result<void> hand_on(int end_row);
  void align(Rect rows);

  Size size_;
  CfaPattern cfa_;
  solver::LateralAlignment alignment_;
  int threads_;
  const BandSink& next_;
  HeldRows held_;
  Image<float> aligned_, demosaiced_;
  Image<std::uint16_t> status_;
  int handed_on_ = 0;  // rows of the image
};

}  // namespace weft::solve
