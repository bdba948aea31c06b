// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "exchange/document.h"

// A material as USD text with UsdPreviewSurface 2.6 (Pixar): a rectangle in the xy plane that looks along z.

namespace weft::exchange {

struct UsdOptions {
  std::array<int, 2> tiles = {1, 1};  ///< repeats that the rectangle shows, along x and y
  /// A file of materialx_of() for the same material, relative to this one; empty: none. Readers with USD's
  /// MaterialX plugin take the surface from there.
  std::string materialx_file = {};
};

/// Metres, y up, `customLayerData` with `size_mm` and the provenance; where the size is not known it is
/// absent, and the rectangle is a metre wide. Sheen, anisotropy and heights have no place in the preview
/// surface. kBadData: as check_material(); several tiles of what does not repeat.
Result<Document> usda_of(const TexturedMaterial& material, const UsdOptions& options = {});

/// A usdz package: `layer_name` (ends in ".usda") first, then the files that the layer names, all aligned.
/// kBadData: a file that is missing or that a package may not hold (PNG, JPEG and EXR may); a layer with a
/// materialx_file; as zip_of().
Result<std::string> usdz_of(const std::string& layer_name, const Document& layer, const FileBytes& files);

}  // namespace weft::exchange
