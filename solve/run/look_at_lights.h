// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "solve/input/light_list.h"

// The lights of photographs, looked at without a solve.

namespace weft::solve {

struct LightsOptions {
  std::filesystem::path source;       ///< a light file, or a folder that has one
  std::filesystem::path photographs;  ///< their folder; empty: as the light file says, or near it
  std::filesystem::path output;       ///< .lp file to write; empty: none
  std::filesystem::path picture;      ///< SVG file to draw; empty: none
};

struct LightsReport {
  LightList list;
  /// Why the photographs were not all found. The lights are known all the same.
  std::string not_found;
};

/// Reads the lights and looks for their photographs; writes and draws what is asked for. `output` is an RTI
/// light file: a count, then "file x y z" a line, with "r g b" behind it where lights have strengths; names
/// are relative to its folder. Errors of reading; kCannotCreate for a file that is there.
Result<LightsReport> look_at_lights(const LightsOptions& options);

/// kCannotCreate for a file that is there: light files and pictures are never overwritten.
Result<void> refuse_existing(const std::filesystem::path& file);

/// An RTI light file as look_at_lights() writes it. kCannotCreate for a file that is there.
Result<void> write_light_file(const LightList& list, const std::filesystem::path& file);

/// From x towards y, and above the table.
struct LightAngles {
  double azimuth_deg = 0, elevation_deg = 0;
};
LightAngles angles_of(const ListedLight& light);

/// Directions seen from above, numbered (report/hemisphere.h).
std::string picture_of(const LightList& list);

/// {"file", "kind", "lights", "assumed", "not_found"}.
Json json_of(const LightsReport& report);

}  // namespace weft::solve
