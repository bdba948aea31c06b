// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/point_spread.h"
#include "solve/bands/bands.h"
#include "solve/bands/held_rows.h"
#include "solver/deblur/sharpen.h"

namespace weft::solve {

/// What sharpening did to a frame.
struct DeblurFacts {
  std::array<double, 3> sigma_px = {};  ///< of the blur, by colour
  double mean_share = 0;                ///< of the correction that was applied, over the frame
};

/// Takes the bands of a solve in order and hands them on sharpened: what lens and focus did to albedo times
/// normal, which is linear in the photographs where no light is shadowed, is undone (solver/deblur) as far as
/// the noise allows. What leaves it lags behind; its maps begin and end together.
/// `planes` are those that were solved.
class Deblur {
 public:
  /// `next` must outlive it.
  Deblur(Size size, const Planes& planes, const PointSpread& spread, int threads, const BandSink& next);

  Result<void> put(const MapBand& band);
  DeblurFacts facts() const;

 private:
  Result<void> hand_on(int end_row);

  Size size_;
  std::optional<CfaPattern> cfa_;
  PointSpread spread_;
  std::array<solver::DeblurFilter, 3> filters_;
  int threads_;
  const BandSink& next_;
  HeldRows held_;
  Image<float> sharpened_;
  int handed_on_ = 0;  // rows of the image
  double shares_ = 0;  // their sum over the rows handed on
};

}  // namespace weft::solve
