// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/lights/light_map.h"
#include "calibration/lights/paper_faults.h"
#include "calibration/lights/per_pixel.h"
#include "calibration/lights/physical.h"
#include "calibration/lights/seed_iteration.h"
#include "calibration/run/calibration_report.h"
#include "calibration/run/sheet_captures.h"

namespace weft::calibration {

/// Degrees that the lights' covariance makes of a normal (rms), level and at a slope of 20 degrees, by cell.
struct PredictedError {
  CellGrid grid;
  std::vector<double> level_deg, slope_deg;
  double centre_deg = 0, corner_deg = 0;  ///< of slope_deg; of the worst corner
};

/// A session that lights were fitted to: no evidence for them any more.
struct FittedSession {
  std::string name;
  std::vector<std::string> lit_sha256;
};

/// What a calibration of lights did, for its report.
struct LightsEvidence {
  std::string rig;
  PaperScene start;
  double flatness_deg = 0;            ///< of the sheet, as it was taken to be
  std::vector<std::string> captures;  ///< names
  std::vector<FittedSession> fitted;
  std::vector<PaperReading> readings;
  std::vector<PaperFault> faults;
  std::optional<LightFit> fit;
  std::optional<PredictedError> predicted;
  std::optional<PerPixelLights> per_pixel;
  std::optional<SeedLights> seed;
  int points = 0;  ///< fixed ones that were found beside the sheet
};

CalibrationReport lights_report(const LightsEvidence& evidence, std::vector<Verdict> verdicts);

/// Chi-square below this says that readings are better than they were taken to be.
inline constexpr double kLaxBelow = 0.5;

/// What such a chi-square makes of the gate, and what to do, in one sentence without a full stop; empty where
/// it is not so low.
std::string lax_gate(const LightsEvidence& evidence);

/// Which capture and which LED depart most from the fit: "sheet03.weft (0.71 percent rms) and LED 4 (0.52)".
std::string worst_of(const LightsEvidence& evidence);

}  // namespace weft::calibration
