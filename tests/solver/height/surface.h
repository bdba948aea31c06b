// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "core/image/image.h"
#include "solver/height/height.h"

namespace weft::test {

/// Height and its slopes at a point, pixels and pixels a pixel, y down the rows.
struct SurfacePoint {
  double height, right, down;
};
using Surface = std::function<SurfacePoint(double x, double y)>;

/// A plain weave of 5-pixel yarns, height rms 0.9, on three Gaussian folds up to 30 pixels high.
SurfacePoint weave_with_folds(double x, double y);

/// Normals of a surface at the centres of pixels, three planes: X right, Y up, Z to the camera.
Image<float> normals_of(Size size, const Surface& surface);
std::array<View<const float>, 3> planes_of(const Image<float>& normals);

/// Turns every normal by an angle whose rms is `sigma_deg`, in a random direction.
void add_noise(Image<float>& normals, double sigma_deg, std::uint64_t seed);

/// Rms of height less truth in pixels, after the plane that fits best has been taken out.
double rms_error_px(View<const float> height, const Surface& truth);
double rms_of(View<const float> height);
/// Rms of a - b.
double rms_difference(View<const float> a, View<const float> b);
double mean_of(View<const float> height);
bool all_finite(View<const float> height);
/// Whether all samples have the same bytes.
bool same_bytes(View<const float> a, View<const float> b);

/// height_from_normals, which must succeed.
solver::Height height_of(const Image<float>& normals, const solver::HeightOptions& options = {},
                         View<const std::uint8_t> mask = {});

}  // namespace weft::test
