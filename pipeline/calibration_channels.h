// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image.h"
#include "core/raw_frame.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::app {

/// Columns and rows from one place where calibration's share of sigma is worked out to the next.
inline constexpr int kCalibrationSigmaStep = 16;

/// Fills `normal_deg` and `relative_albedo` of a band of rows from its solved normals and albedo (of a mosaic
/// each photosite's own, else green), all views as large as the band, (0, 0) being its corner. Worked out at
/// every 16th pixel, and at the last column and row of the band, from the normal there; bilinear between. The
/// same bytes for any number of threads; the height of the band matters. `cfa` is that of a mosaic, or null.
void fill_calibration_sigma(const solver::CalibrationSigmas& sigmas, Rect band,
                            const std::array<View<const float>, 3>& normal, View<const float> albedo,
                            const CfaPattern* cfa, int threads, View<float> normal_deg,
                            View<float> relative_albedo);

}  // namespace weft::app
