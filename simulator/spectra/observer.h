// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/result.h"
#include "core/image/color_spaces.h"
#include "simulator/spectra/spectrum.h"

// What three channels make of a reflectance. The camera under a LED and the standard observer under daylight
// weigh the wavelengths differently, and neither is a linear map of the other.

namespace weft::simulator {

/// What each channel of the camera passes and records: red, green, blue.
using Filters = std::array<Spectrum, 3>;

/// How three channels weigh a reflectance under one light: channel c sees the sum of weights[c][i] times
/// sample i. Each channel's weights sum to 1, so that a perfect white is 1; those of Rec.709 are negative
/// here and there.
using ChannelWeights = std::array<std::array<double, Spectrum::kSamples>, 3>;

/// The camera's under a LED. kBadData if a filter passes nothing of the LED's light.
Result<ChannelWeights> camera_weights(const Spectrum& led, const Filters& filters);

/// Those of linear Rec.709 under CIE D65.
const ChannelWeights& rec709_weights();

/// The observer's x, y, z themselves, each summing to 1: what all cameras without colour errors see.
ChannelWeights observer_weights();

/// What a surface gives relative to a perfect white under the same light: 0 to 1 with the camera's weights.
Rgb channel_reflectance(const ChannelWeights& weights, const Spectrum& reflectance);

/// Linear Rec.709 under D65, white = 1: the albedo that truth holds. A saturated colour outside Rec.709 has a
/// channel below 0 or above 1. The observer is CIE 1931 by the fit of Wyman, Sloan and Shirley ("Simple
/// analytic approximations to the CIE XYZ color matching functions", JCGT 2(2), 2013, section 2.2), which
/// differs from the tables by about 1 percent of their peak; white is what this fit makes of D65, channel by
/// channel.
inline Rgb rec709_albedo(const Spectrum& reflectance) {
  return channel_reflectance(rec709_weights(), reflectance);
}

/// Light of a LED in each channel over that in green: `white_balance` of a scene's lights. kBadData if a
/// filter passes nothing of it.
Result<Rgb> camera_white_balance(const Spectrum& led, const Filters& filters);

/// CIE 1931 x, y of a light that is not dark.
std::array<double, 2> chromaticity(const Spectrum& light);

}  // namespace weft::simulator
