// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"
#include "exchange/export/export_request.h"
#include "exchange/export/map_folder.h"
#include "exchange/presets/preset.h"
#include "material/assets/runtime.h"

// What is known of an export before its first file is made.

namespace weft::exchange {

/// A texture that is to be written.
struct TextureToWrite {
  PresetFile file;
  std::string name;  ///< relative to the folder of the export
};

/// A preset filled in for one cloth: all that is to be written.
struct FilledPreset {
  Preset preset;
  std::string title;  ///< of the cloth, for people
  std::string name;   ///< of the cloth in file names
  Size size;
  PixelPitch pitch_mm = {};  ///< 0: not known
  std::vector<TextureToWrite> textures;
  std::vector<PresetDocument> documents;  ///< with the cloth's name in theirs
  std::vector<std::string> notes;         ///< sentences that people should read
  std::filesystem::path folder;
  Json inputs = {};     ///< all that the bytes depend on, once identify() was asked
  std::string id = {};  ///< its hash
};

struct PreparedExport {
  ExportOptions options;  ///< `input` is a folder
  MapFolder folder;
  std::vector<FilledPreset> presets;  ///< each in a folder of its own
};

/// Derived maps that files of these presets cannot do without. A preset that is none needs nothing.
std::vector<std::string> needed_maps(const std::vector<std::string>& presets);

/// Builds the material where the input is one, opens its folder and fills in each preset: checks all that can
/// be checked without a pixel. Errors of build_materials() and export_maps().
Result<PreparedExport> prepare_export(const ExportOptions& asked, const JobContext& context);

/// Names each preset by what its files are made of.
Result<void> identify(PreparedExport& prepared);

/// Bytes that the textures take at most.
std::uint64_t most_bytes(const FilledPreset& preset);

/// A layer that a material mixes while it is drawn.
struct LayerToWrite {
  MapFolder maps;
  FilledPreset preset;  ///< of the material, with the textures in layers/NAME/
};
struct LayersToWrite {
  material::RuntimeStack stack;
  std::vector<LayerToWrite> layers;  ///< all of the stack but the lowest, which is the material itself
};

/// Those of a built material (`[runtime]`, docs/materials.md) whose preset has a document of them; else none.
/// Errors of runtime_stack_of(), open_map_folder() and prepare_export().
Result<LayersToWrite> layers_of(const FilledPreset& preset, const MapFolder& maps);

}  // namespace weft::exchange
