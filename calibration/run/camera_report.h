// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/camera/lateral_fit.h"
#include "calibration/camera/lens_fit.h"
#include "calibration/run/board_photographs.h"
#include "calibration/run/calibration_report.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

/// What is known once the lens is fitted.
struct CameraFitFacts {
  const BoardPhotographs& photographs;
  std::span<const std::size_t> viewed;  ///< the photograph of each view
  std::span<const BoardView> views;     ///< as fitted
  const LensFit& fit;
  std::vector<Fiducial> fiducials;
  std::optional<PointSpread> spread;  ///< of the lens; nothing where too few edges show it
  std::optional<LateralFit> lateral;  ///< nothing where too few edges show it
  std::optional<Calibration> from;    ///< the calibration that the other parts come from
  std::string rig;
};

/// A sentence for each photograph that is not used, without a full stop.
std::vector<std::string> left_out(const CameraFitFacts& facts);

/// The report of `weft calibrate camera`. Its verdicts are of the calibration, not of photographs left out.
CalibrationReport camera_report(const CameraFitFacts& facts);

}  // namespace weft::calibration
