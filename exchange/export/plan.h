// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"
#include "exchange/export/export.h"
#include "exchange/export/map_folder.h"
#include "exchange/presets/pack.h"

namespace weft::app {

struct PlannedFile {
  exchange::PresetFile file;
  std::string name;  ///< relative to the folder of the export
};
struct PlannedDocument {
  exchange::DocumentKind kind = exchange::DocumentKind::kGlb;
  std::string name;
};

/// What will be written for one preset.
struct PlannedExport {
  exchange::Preset preset;
  std::string title;  ///< of the cloth, for people
  std::string name;   ///< of it in file names
  Size size;
  PixelPitch pitch_mm = {};  ///< 0: not known
  std::vector<PlannedFile> files;
  std::vector<PlannedDocument> documents;
  std::vector<std::string> notes;  ///< sentences that people should read
  std::filesystem::path folder;
  Json inputs;  ///< all that the bytes depend on
  std::string id;
};

/// Checks all that can be checked without a pixel. Errors as of export_maps().
Result<std::vector<PlannedExport>> plan_exports(const ExportOptions& options, const MapFolder& folder);

/// The plan of one preset.
Result<PlannedExport> plan_preset(const ExportOptions& options, const MapFolder& folder,
                                  exchange::Preset preset);

/// Names the plan again by what it now holds, after its files were changed.
Result<void> seal(const ExportOptions& options, const MapFolder& folder, PlannedExport& plan);

/// Bytes that the files take at most, without documents.
std::uint64_t most_bytes(const PlannedExport& plan);

}  // namespace weft::app
