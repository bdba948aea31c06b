// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/image.h"

// What can be looked at of a folder of maps: those of a solve, a set that weft maps made, or the truth of a
// simulated session.

namespace weft::app {

enum class LayerKind {
  kNormal,  ///< X, Y, Z
  kColor,   ///< R, G, B, linear
  kScalar,  ///< one value
  kFlags,   ///< bits of StatusBit (core/solve/solve_record.h)
  kMosaic,  ///< a raw frame
};
const char* name_of(LayerKind kind);  ///< "normal"

/// One map among those of a folder.
struct Layer {
  std::string name;  ///< "sigma_noise"
  LayerKind kind = LayerKind::kScalar;
  std::string unit;                   ///< "deg", "mm", "share", "decades"; empty: none
  std::string file;                   ///< in the folder
  std::vector<std::string> channels;  ///< of the file
  bool is_deviation = false;          ///< averages as the root of the mean of squares
};

/// The layers of the maps that a folder has, normal first. Errors of read_image_info(); kNoInput where there
/// are none.
struct Layers {
  Size size;
  std::vector<Layer> all;

  const Layer* find(const std::string& name) const;
};
Result<Layers> layers_of(const std::filesystem::path& folder);

/// The same of a set of maps, and those that its maps.json names: of scalars the first channel. One of
/// another size, or that cannot be read, is left out. kBadData where the document has no list of maps.
Result<Layers> layers_of_set(const std::filesystem::path& folder, const Json& document);

}  // namespace weft::app
