// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "exchange/export/encode_files.h"
#include "exchange/export/map_folder.h"
#include "exchange/export/plan.h"
#include "exchange/textured_material.h"

namespace weft::app {

/// The material that the textures of a plan make: each parameter is the first file that holds all its
/// channels side by side, its constant the mean of its values. What no file holds is left out. What is one
/// number everywhere has no texture; what glTF samples together (colour and opacity, roughness and metal,
/// strength and direction of anisotropy) only where all of it in one file is.
exchange::TexturedMaterial textured_material(const PlannedExport& plan, const MapFolder& maps,
                                             const std::vector<EncodedFile>& files);

/// Whether a texture holds nothing but numbers that documents say: each of its channels is one number, and
/// none of the files that they name or hold is it.
bool is_said_as_number(const EncodedFile& file, const std::vector<std::string>& named);

}  // namespace weft::app
