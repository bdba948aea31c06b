// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/rig/session.h"

namespace weft {

/// How full a frame is, as a scan writes it down with each lit shot and bracket ("exposed").
struct Exposed {
  double clipped = 0;  ///< share of the fullest channel at or above white
  double room = 0;     ///< times its exposure that the meter would allow; under 1 where it is over
};
void set_exposed(const Exposed& exposed, Json& shot);
/// None of a shot that no scan of this version took.
std::optional<Exposed> exposed_in(const Json& shot);
std::optional<Exposed> exposed_of(const Shot& shot);

/// From this share on a LED is over, below it highlights are.
inline constexpr double kOverFrom = 0.05;
/// What a metered scan may have full.
inline constexpr double kMostClipped = 1e-5;
/// From so many times on a scan is dark: noise is twice what it could be.
inline constexpr double kDarkFrom = 4;
/// A frame that is good for nothing: half full, or four stops too dark.
inline constexpr double kUselessFrom = 0.5, kUselessDarkFrom = 16;
/// Why one of this exposure is that; empty: it is not, or its bracket at so many times the exposure mends it.
std::string why_useless(const Exposed& exposed, double exposure_us, double bracket);

/// What is wrong with the exposure of a session's shots, of all of them in one sentence with one thing to do;
/// empty: nothing. Of a LED's shots, its brackets among them, the best counts; superseded ones do not.
std::string exposure_warning(const Session& session);

/// Whether that is more than highlights: a LED is over, or all are dark.
bool is_exposed_wrong(const Session& session);

}  // namespace weft
