// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "core/base/result.h"
#include "solve/input/light_list.h"

// Lights that programs write as JSON.

namespace weft::solve {

/// Lights of RelightLab (.dome: directions, positionsSphere, positions3d, ledAdjust; .relight: the same under
/// "dome", and images) or of Meshroom ("lights": a list with viewId or lightId, direction and intensity, or
/// an object by names of photographs). RelightLab's axes are weft's; Meshroom's y points down and its z away,
/// and are turned round. Photographs that a project skips are left out. kBadData for anything else.
Result<LightList> read_light_json(std::string_view text, const std::filesystem::path& file);

/// Gives each light that has a view the photograph of that view, by a file of Meshroom (.sfm: "views" with
/// viewId and path). False, and nothing is given, where it lacks one of them. kBadData for what is no such
/// file.
Result<bool> name_views(std::string_view sfm, const std::filesystem::path& file, LightList& list);

/// Whether a text has members that read_light_json() knows.
bool is_light_json(std::string_view text);

}  // namespace weft::solve
