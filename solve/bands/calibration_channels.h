// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solve/bands/bands.h"
#include "solve/photographs/photographs.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::solve {

/// Columns and rows from one place where calibration's share of sigma is worked out to the next.
inline constexpr int kCalibrationSigmaStep = 16;

/// Fills `normal_deg` and `relative_albedo` of a band of rows from its solved normals and albedo (of a mosaic
/// each photosite's own, else green), all views as large as the band, (0, 0) being its corner. Worked out at
/// every 16th pixel, and at the last column and row of the band, from the normal there; bilinear between. The
/// same bytes for any number of threads; the height of the band matters.
void fill_calibration_sigma(const solver::CalibrationSigmas& sigmas, Rect band,
                            const std::array<View<const float>, 3>& normal, View<const float> albedo,
                            const Planes& planes, int threads, View<float> normal_deg,
                            View<float> relative_albedo);

/// What the calibration's covariance makes of solved maps, for the rows of a band whose albedo is ready.
class CalibrationChannels {
 public:
  /// kBadData as CalibrationSigmas::make. `photographs` must outlive this and hold a covariance.
  static Result<CalibrationChannels> make(const Photographs& photographs, int threads);

  /// R, G, B of the albedo, absolute, and the angle of the normal, over band.albedo_rows; valid until the
  /// next call. Bands come in order.
  std::array<View<const float>, 4> of(const MapBand& band);

 private:
  CalibrationChannels(const Photographs& photographs, solver::CalibrationSigmas sigmas, int threads);
  void keep_normals(const MapBand& band);
  void forget_normals(int rows_left);

  int width_;
  Planes planes_;
  solver::CalibrationSigmas sigmas_;
  int threads_;
  Image<float> normal_;  ///< of all rows whose albedo is to come
  int rows_ = 0;         ///< rows of normal_ that are filled
  Image<float> albedo_, relative_, channels_;
};

}  // namespace weft::solve
