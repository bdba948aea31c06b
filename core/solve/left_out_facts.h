// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/describe/fields.h"

namespace weft {

/// How well readings of lights that were left out of a solve are predicted from the others, over lit
/// readings. Shares: 0.05 is five percent.
struct LeftOutShares {
  double median = 0;  ///< of |error| / reading
  double rms = 0;     ///< of error / brightness of the pixel, each cut to 1
  /// The same as noise alone would give them; none where the camera's noise is not known.
  std::optional<double> noise_median = {}, noise_rms = {};
  std::int64_t readings = 0;  ///< that were predicted

  friend bool operator==(const LeftOutShares&, const LeftOutShares&) = default;
};

struct LeftOutLight {
  int light = 0;  ///< its number, as a person knows it
  LeftOutShares shares;

  friend bool operator==(const LeftOutLight&, const LeftOutLight&) = default;
};

/// What `check` of solve.json says.
struct LeftOutFacts {
  LeftOutShares all;
  std::vector<LeftOutLight> lights;  ///< those of which readings were predicted

  friend bool operator==(const LeftOutFacts&, const LeftOutFacts&) = default;
};

/// What no left-out light can show: for every place that names the figures.
inline constexpr const char* kLeftOutBlindSpot =
    "A scale and a slow tilt that all lights share cannot be seen this way.";

/// {"median", "rms", "noise_median", "noise_rms", "readings", "lights": [{"light", and the same}]}
void describe(Fields& fields, LeftOutFacts& facts);

}  // namespace weft
