// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "exchange/document.h"

namespace weft::exchange {

/// How textures share files.
enum class Packing {
  kGltf,  ///< base and opacity; occlusion, roughness and metal; direction and strength; sheen; its roughness
  kSeparate,  ///< a grey file a number
};

struct SampleOptions {
  Packing packing = Packing::kGltf;
  Size size = {64, 64};
  std::optional<std::array<double, 2>> size_mm = {{8, 8}};
  int bits = 8;  ///< of the normals
  bool has_opacity = true;
  bool has_sheen = true;  ///< and anisotropy
  bool has_f0_texture = false;
};

/// A closed form of a plain weave: relief 0.08 mm cos(8 pi u) cos(8 pi v), whose slopes are its normals.
struct SampleMaterial {
  TexturedMaterial material;
  std::map<std::string, std::string> files;
  FileBytes bytes() const { return {files.begin(), files.end()}; }
};
SampleMaterial sample_material(const SampleOptions& options = {});

/// The same cloth as numbers alone.
TexturedMaterial constant_material();

}  // namespace weft::exchange
