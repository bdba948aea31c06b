// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/camera/markers.h"
#include "calibration/run/sheet_files.h"
#include "core/rig/camera.h"
#include "core/rig/session.h"

// What can be wrong with a scan for a calibration and is seen without solving it.

namespace weft::calibration {

/// Why the room is too bright, from the dark photograph; empty: it is dark, or nobody photographed it so.
std::string lamp_in(const Session& session);

/// Why a sheet's paper is not smooth, by every third LED's photograph; empty: it is.
std::string unevenness_of(const Session& session, const CameraModel& camera, const TaggedSheet& sheet,
                          const SheetPose& pose);

/// What a chart's scan shows of how it lies.
struct ChartLook {
  std::string why_not;  ///< it cannot be read; empty: it can
  std::string note;     ///< it lies upside down, which does no harm
  /// Outer corners of its outer patches, in shares of the picture; empty: no chart was found.
  std::vector<std::array<double, 2>> outline = {};
};

/// By the sum of a few lit photographs, for even light. `set`: the folder that chart.toml may lie in; `from`:
/// the calibration whose response makes photographs linear (may be empty).
ChartLook look_at_chart_scan(const Session& session, const std::filesystem::path& set,
                             const std::filesystem::path& from);

}  // namespace weft::calibration
