// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/color/chart_reference.h"
#include "calibration/color/color_fit.h"
#include "calibration/run/calibration_report.h"

namespace weft::calibration {

/// What a colour calibration found.
struct ColorMeasurement {
  std::string reference;             ///< which values the chart was held against
  std::vector<std::string> sources;  ///< names of the pictures: a calibration is the same wherever they lie
  std::vector<int> patches;          ///< those fitted, from 0
  std::vector<ChartSample> samples;  ///< of the patches, without shading and scale
  ColorFit fit;
  std::vector<double> by_curve, curve_left_out;  ///< CIEDE2000 of each, where a curve was fitted
  ColorTransform transform;
  double albedo_scale = 1;    ///< chart over solved albedo; of sessions
  bool has_albedo = false;    ///< a session is among the sources
  double slope_of_light = 0;  ///< brightest over darkest place of the chart less 1, of photographs
  std::vector<Verdict> verdicts;
};

/// Its report: patches as they should be beside what came out, and CIEDE2000 of each.
CalibrationReport report_of(const ColorMeasurement& color, const std::string& rig);

/// Mean of a list; 0 of none.
double mean_of(const std::vector<double>& values);

/// The patches as they are fitted: each with its reference on the left, and on the right what it became.
std::string patches_svg(const ColorMeasurement& color);

}  // namespace weft::calibration
