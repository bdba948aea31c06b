// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/image.h"
#include "core/point_spread.h"
#include "core/result.h"
#include "pipeline/bands.h"
#include "solver/deblur/sharpen.h"

namespace weft::pipeline {

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
  void append(const MapBand& band);
  Result<void> hand_on(int end_row);
  void forget_rows();

  Size size_;
  std::optional<CfaPattern> cfa_;
  PointSpread spread_;
  std::array<solver::DeblurFilter, 3> filters_;
  int threads_;
  const BandSink& next_;
  // Rows of the image from first_row_ on. Planes: normal X, Y, Z, albedo, its sigma, sigma of the normal, and
  // of what is kept, model_albedo and model_normal_deg.
  Image<float> maps_, sharpened_;
  Image<float> residual_;
  Image<std::uint16_t> status_;
  bool has_model_ = false;
  int first_row_ = 0;
  int complete_ = 0;   // rows of the image that all maps have
  int handed_on_ = 0;  // of those
  double shares_ = 0;  // their sum over the rows handed on
};

}  // namespace weft::pipeline
