// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/product.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/image/image.h"
#include "exchange/presets/loss.h"
#include "exchange/presets/preset.h"

// What export.json says of the files of a preset (weft.export/1).

namespace weft::exchange {

inline constexpr ProductKind kExportProduct = {"weft.export", "export.json", "export",
                                               "make it first with weft export"};

/// By how much a channel's values differ from the maps'.
struct NumberLoss {
  double mean = 0, most = 0;
};

struct ExportedChannel {
  std::string name, unit, source = {};
  std::optional<double> at_0 = {}, at_1 = {};  ///< of integers: the values that 0 and full scale stand for
  double least = 0, most = 0, mean = 0;        ///< of the maps' values
  NumberLoss lost = {};
  double cut_share = 0;  ///< of the pixels that the file cannot hold
};

struct ExportedTexture {
  std::string file = {}, sha256 = {};  ///< relative to the folder
  std::uint64_t bytes = 0;
  Size size = {};
  int levels = 1;
  std::string encoding = {};
  ColorSpace color = {};
  std::string direction = {}, roughness = {};  ///< empty: it has none
  std::vector<ExportedChannel> channels = {};
  Loss lost = {};
  std::string inside = {};  ///< the document that alone holds it; empty: it lies in the folder
};

/// A document as it was written.
struct ExportedDocument {
  std::string name;
  std::string kind;
  std::string sha256;
  std::uint64_t bytes = 0;
  std::vector<std::string> files = {};     ///< that it names or holds
  std::vector<std::string> left_out = {};  ///< what its format cannot hold
};

struct ExportFacts {
  std::string id, preset, name, title;                  ///< name: of the cloth in file names
  std::string normal, roughness;                        ///< the preset's direction and convention
  Size size = {};                                       ///< of the largest level
  std::vector<double> mm_per_pixel = {}, size_mm = {};  ///< one of square pixels; empty: nobody knows
  bool is_size_known = true;                            ///< else they are assumed
  bool is_tile = false;
  std::string albedo_scale = {};
  std::vector<std::string> notes = {};
  std::vector<ExportedTexture> files = {};
  std::vector<ExportedDocument> documents = {};
  Json from = Json::object();  ///< provenance_of()
  Json document = {};          ///< as it was read, so that fields of newer versions survive
};
void describe(Fields& fields, ExportFacts& facts);
Json json_of(const ExportFacts& facts);

/// Reads export.json of a folder. kNoInput, kBadData.
Result<ExportFacts> read_export(const std::filesystem::path& folder);

}  // namespace weft::exchange
