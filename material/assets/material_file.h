// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "material/assets/material_place.h"

// weft.material/1: what a person writes of a material (docs/materials.md). A file says only what differs from
// the one that it inherits.

namespace weft::material {

inline constexpr const char* kMaterialSchema = "weft.material";
inline constexpr int kMostGenerations = 16;
/// Beside the material itself: each takes a channel of the weights, R, G and B.
inline constexpr int kMostRuntimeLayers = 3;

/// A value with the file that it came from.
struct KeptValue {
  Json value;
  std::string from;
  friend bool operator==(const KeptValue&, const KeptValue&) = default;
};
/// Values by key. Their form is one, however they were written: a number or colour is a list; a map an object
/// {"map", "scan"} with whatever was said of it; files are absolute.
using KeptValues = std::map<std::string, KeptValue>;

/// A layer, or what a child changes of it.
struct MaterialLayer {
  std::string name;
  KeptValues values;     ///< material, mask, alpha, only, blend, normals, tile_mm, offset_mm, turn_deg, tint
  bool removes = false;  ///< takes it out
  std::string after;     ///< stands above the layer of this name; empty: on top
  friend bool operator==(const MaterialLayer&, const MaterialLayer&) = default;
};

/// One file, as it is written.
struct MaterialFile {
  MaterialPlace place;
  std::string inherits;  ///< as written; empty: nothing
  KeptValues top;        ///< name, notes, size_mm, is_tile, pixels, scan
  KeptValues surface;    ///< by name of parameter: the material's own, which layers lie on
  KeptValues over;       ///< likewise: what holds above all layers
  std::vector<MaterialLayer> layers;
  KeptValues runtime;                         ///< weights
  std::vector<MaterialLayer> runtime_layers;  ///< of a material alone
  std::vector<std::string> unset;             ///< "surface.normal", "size_mm", "runtime"
};

/// kBadData with file and key for a syntax error, a newer major schema, an unknown key (the nearest known one
/// is named), a value of another kind, out of range or in another unit. Nothing is opened.
Result<MaterialFile> parse_material(std::string_view text, const MaterialPlace& place);

/// parse_material() of its text.
Result<MaterialFile> read_material(const MaterialPlace& place);

}  // namespace weft::material
