// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/image/color_spaces.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

/// One patch of a chart.
struct ChartSample {
  Rgb camera = {};      ///< linear, in the camera's channels, white balanced
  Rgb reference = {};   ///< linear Rec.709
  double u = 0, v = 0;  ///< place on the chart, -1 to 1
};

/// What is fitted beside the matrix.
enum class ChartLight {
  kEven,    ///< one scale: albedo that was solved
  kSloped,  ///< log light a plane over the chart
  kShaded,  ///< log light a quadratic of place: a photograph under one lamp
};

/// A matrix whose rows sum to 1 with what goes with it.
struct ColorFit {
  Mat3 rec709_from_camera = {};
  std::vector<double> covariance;  ///< 9 x 9 by rows, of its entries by rows; of rank 6
  double scale = 1;                ///< reference = matrix * camera * scale, in the middle of the chart
  std::vector<double> light;       ///< of each sample, over that of the middle
  std::vector<double> off;         ///< CIEDE2000 of each sample, fitted
  std::vector<double> left_out;    ///< of each sample, by the fit to all others; empty unless asked for
  std::vector<double> before;      ///< of each sample without matrix, with the scale that suits it best
};

/// Minimises the sum over samples of (Lab - Lab_ref)^T G (Lab - Lab_ref), by Gauss-Newton over the six free
/// entries, log scale and shading. G is the metric of CIEDE2000 at the reference: the quadratic form that its
/// square is for small differences, taken from differences of 0.05. So the weights are those of CIEDE2000 and
/// the problem is smooth. `leave_one_out` also fits without each sample in turn. kBadData below 9 samples, or
/// where they do not determine a matrix: colours that are within 2 percent of grey, or of one line, are
/// noise.
Result<ColorFit> fit_color(std::span<const ChartSample> samples, ChartLight light, bool leave_one_out);

/// The light of each sample over what the others would get in its place, if their light is a plane over the
/// chart. Samples that are far off have no say in the fit: their weights are those of Geman and McClure, with
/// a scale that falls from 12 to 3 units of CIEDE2000. It starts from even and from sloped light, and the
/// better end counts. So a shadow is told from a lamp to one side, as long as most of the chart is out of it.
Result<std::vector<double>> light_of_each(std::span<const ChartSample> samples);

/// Affine, cubic, affine in xyY (seed 004, "Calibrating Albedo"), fitted one after the other by linear least
/// squares as there; the camera's colours count as Rec.709 before it. `scale` as of fit_color().
Result<ColorCurve> fit_color_curve(std::span<const ChartSample> samples, double scale);

/// CIEDE2000 of two linear colours.
double ciede2000_of(const Rgb& first, const Rgb& second);

}  // namespace weft::calibration
