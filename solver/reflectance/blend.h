// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/base/vec.h"
#include "core/solve/status_blend.h"
#include "solver/reflectance/lobe.h"
#include "solver/reflectance/pixel_fit.h"

// Where two materials meet, or a print fades, a pixel is of both.

namespace weft::solver {

/// Two materials over one normal and one albedo. A reading is the mean of what each reflects, by their shares
/// of the pixel.
struct Blend {
  Lobe first, second;
  double second_share = 0;  ///< of the pixel, 0 to 1
};
/// As of one lobe.
double specular(const Blend& blend, Vec3 normal, const LitFrom& from, double yarn);
double modelled(const Blend& blend, Vec3 b, const LitFrom& from, double yarn);

/// The albedo that readings leave once what shines is taken off them, where the normal is known, by least
/// squares; none where no reading is lit.
std::optional<double> albedo_beneath(const Blend& blend, std::span<const LobeReading> readings, Vec3 normal,
                                     double yarn);

/// A blend costs at most this of what the better of the two materials does: it has a share to turn.
inline constexpr double kBlendCosts = 0.5;

struct BlendFit {
  double second_share = 0;
  unsigned second_parts = 0;  ///< the same in kBlendParts; 0 and kBlendParts: of one material alone
  PixelFit fit;
};
/// A pixel's share and b together by Gauss-Newton from `start` and from halves.
BlendFit fit_blend(const Lobe& first, const Lobe& second, std::span<const LobeReading> readings, Vec3 start,
                   double yarn);

/// Variances of b along its normal and across it: of the readings, with a share that is open, and of lobes
/// that are one sigma off (lobe_fit.h), to first order.
struct BlendVariances {
  double along_of_readings = 0, across_of_readings = 0, along_of_lobes = 0, across_of_lobes = 0;
};
BlendVariances variances_of(const Blend& blend, std::span<const Lobe> first_off,
                            std::span<const Lobe> second_off, std::span<const LobeReading> readings, Vec3 b,
                            double yarn);

}  // namespace weft::solver
