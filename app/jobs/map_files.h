// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/image_io/image_io.h"
#include "core/result.h"
#include "pipeline/bands.h"
#include "pipeline/photographs.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::app {

/// What the calibration's covariance makes of solved maps, for the rows of a band whose albedo is ready: the
/// `.calibration` channels of sigma.exr.
class CalibrationChannels {
 public:
  /// kBadData as CalibrationSigmas::make. `photographs` must outlive this and hold a covariance.
  static Result<CalibrationChannels> make(const Photographs& photographs, int threads);

  /// R, G, B of the albedo, absolute, and the angle of the normal, over band.albedo_rows; valid until the
  /// next call. Bands come in order.
  std::array<View<const float>, 4> of(const MapBand& band);

 private:
  CalibrationChannels(const Photographs& photographs, solver::CalibrationSigmas sigmas, int threads);

  const Photographs* photographs_;
  solver::CalibrationSigmas sigmas_;
  int threads_;
  Image<float> normal_;  ///< of all rows whose albedo is to come
  int rows_ = 0;         ///< of them
  Image<float> albedo_, relative_, channels_;
};

/// The map files of a solve, written band by band: docs/formats.md.
class MapFiles {
 public:
  /// `calibration` names what sigma.exr has beside the noise: "R", "G", "B", "normal_deg", as
  /// "R.calibration" and so on.
  static Result<MapFiles> open(const std::filesystem::path& folder, Size size, const std::string& compression,
                               const std::vector<std::string>& calibration);
  /// `calibration` has a view over band.albedo_rows for each of those names.
  Result<void> write(const MapBand& band, std::span<const View<const float>> calibration);
  Result<void> finish();

 private:
  std::optional<ImageWriter> normal_, albedo_, sigma_, residual_, status_;
};

}  // namespace weft::app
