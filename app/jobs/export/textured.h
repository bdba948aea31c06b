// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/jobs/export/encode_files.h"
#include "app/jobs/export/map_folder.h"
#include "app/jobs/export/plan.h"
#include "exchange/textured_material.h"

namespace weft::app {

/// The material that the textures of a plan make: each parameter is the first file that holds all its
/// channels side by side, its constant the mean of its values. What no file holds is left out.
exchange::TexturedMaterial textured_material(const PlannedExport& plan, const MapFolder& maps,
                                             const std::vector<EncodedFile>& files);

}  // namespace weft::app
