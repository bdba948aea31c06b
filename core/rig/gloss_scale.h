// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

// The width of a lobe under the names that engines and studios give it. Inside weft it is alpha of GGX, 0 to
// 1 (Walter et al. 2007); a file that holds another number says which.

namespace weft {

/// What a channel of roughness or gloss holds.
enum class GlossScale {
  kAlpha,       ///< alpha itself: "roughness" of seed 000
  kRoughness,   ///< its root, 0 to 1: "roughness" of seed 002, of glTF and of most engines
  kGloss,       ///< g of alpha = sqrt(2 / (1 + 2^(18 g))), 0 rough to 1 (seed 001 eq. 2)
  kBlinnPhong,  ///< g of the power m = 2^(13 g), 0 rough to 1, where alpha^2 = 2 / (m + 2) (seed 004)
};

const char* name_of(GlossScale scale);  ///< "alpha", "roughness", "gloss", "blinn-phong"
std::optional<GlossScale> gloss_scale_named(std::string_view name);

/// The alphas that a scale has a number for: 0.00276 to 1 of kGloss, 0.0156 to 0.8165 of kBlinnPhong.
struct AlphaRange {
  double least = 0, most = 1;
};
AlphaRange alpha_range(GlossScale scale);

/// `alpha` on the scale, from 0 to 1; an alpha out of its range is its nearest.
double on_scale(GlossScale scale, double alpha);
/// The alpha of a value on the scale; a value out of 0 to 1 is its nearest. The inverse of on_scale() in
/// range.
double alpha_of(GlossScale scale, double value);

/// Power of the Blinn-Phong lobe that falls off as Beckmann's of alpha does, and back: alpha^2 = 2 / (m + 2)
/// (Walter et al. 2007). GGX of the same alpha falls off twice as fast at its peak, and slower in its tail.
double blinn_phong_power(double alpha);
double alpha_of_power(double power);

}  // namespace weft
