// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "material/run/map_set_facts.h"

namespace weft::material {

/// report.html of a set of maps (weft.maps/1): what speaks against it, each map with its picture, range and
/// source, and what each step of the recipe found. The pictures are in `folder`.
Result<void> write_maps_page(const std::filesystem::path& folder, const MapSetFacts& facts);

}  // namespace weft::material
