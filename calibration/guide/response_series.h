// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "calibration/guide/photograph_set.h"
#include "calibration/guide/set_guide.h"
#include "capture/scan/series.h"
#include "core/base/result.h"

// Series that nobody has a hand in: pairs of photographs alike, at several exposures.

namespace weft::calibration {

/// Steps of the parts response (lit, then dark) and trap.
Result<SetStanding> look_at_series(const PhotographSet& set);

/// Names of the sets in a folder that are of these parts and have all their photographs, sorted.
std::vector<std::string> complete_series(const std::filesystem::path& sets);

/// What a step of these parts photographs. `share_of_us` gives a time that the camera has.
std::vector<capture::SeriesShot> series_of(const SetStep& step, int leds,
                                           const std::function<double(double share)>& share_of_us);

}  // namespace weft::calibration
