// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "material/assets/digests.h"
#include "material/assets/map_set.h"
#include "material/assets/resolve.h"
#include "material/layers/fit.h"

namespace weft::material {

/// Raised whenever the bytes of a built material may change.
inline constexpr int kMaterialBuilder = 2;

/// The grid of a material without a map has this many pixels a side.
inline constexpr int kPlainSide = 16;

/// A material with all that its maps depend on.
struct MaterialNode {
  ResolvedMaterial material;
  std::string name;  ///< for people
  Json inputs;       ///< all that its bytes depend on: no path, no date
  std::string id;    ///< product_id() of them
  Size size;
  std::optional<std::array<double, 2>> size_mm = {};
  bool is_size_known = true;  ///< else it is assumed
  bool is_tile = true;
  bool has_map = false;     ///< some parameter varies
  bool has_relief = false;  ///< its height does
  std::map<std::string, MapFile> maps =
      {};  ///< by "surface.normal", "over.albedo", "layer.dust.mask", "runtime.weights"
  std::vector<std::size_t> layers = {}, runtime = {};  ///< nodes of their materials
  std::vector<std::optional<LayerFit>> fits = {};      ///< of each layer that has a map

  /// The side of a pixel; 0 where the size is not known.
  double mm_per_pixel() const { return size_mm ? (*size_mm)[0] / size.width : 0; }
};

struct MaterialTree {
  std::vector<MaterialNode> nodes;  ///< each after those that it lies on
  std::vector<std::size_t> roots;
};

/// Resolves the materials and those of their layers, and looks at every map: what cannot be built is refused
/// before work begins. Errors of resolve_material(), find_map() and fit_layer(), with file and key; kBadData
/// for layers in a circle (with the chain), maps of different sizes, pixels that are not square and a mask
/// from a height where there is none.
Result<MaterialTree> plan_materials(const std::vector<MaterialPlace>& roots, const MaterialSource& source,
                                    DigestCache& digests);

/// The sets of maps that a node and its layers take from: "session", "maps", "solve", "level" and, where it
/// is so, "draft" and "stale", sentences of why today another would be made.
Json scans_of(const MaterialTree& tree, std::size_t index);

/// Files that the tree is made of, without what weft brings along.
std::vector<std::filesystem::path> files_of(const MaterialTree& tree);

/// The tree in the language of Graphviz: a box a material, an arrow from what it lies on, a dashed one from
/// its parent, an ellipse a map.
std::string graph_of(const MaterialTree& tree);

}  // namespace weft::material
