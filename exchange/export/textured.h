// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "exchange/export/map_folder.h"
#include "exchange/export/prepare.h"
#include "exchange/presets/export_facts.h"
#include "exchange/textured_material.h"

namespace weft::exchange {

/// The textures of a cloth as they were written, and what they were made of.
struct ClothTextures {
  const MapFolder& maps;
  const FilledPreset& preset;
  const std::vector<ExportedTexture>& textures;  ///< in the order of the preset
};

/// The material that the textures make: each parameter is the first file that holds all its channels side by
/// side, its constant the mean of its values. What no file holds is left out. What is one number everywhere
/// has no texture; what glTF samples together (colour and opacity, roughness and metal, strength and
/// direction of anisotropy) only where all of it in one file is.
TexturedMaterial textured_material(const ClothTextures& cloth);

/// Whether a texture holds nothing but numbers that documents say: each of its channels is one number, and
/// none of the files that they name or hold is it.
bool is_said_as_number(const ExportedTexture& texture, const std::vector<std::string>& named);

}  // namespace weft::exchange
