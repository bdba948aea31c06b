// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "material/filtering/detail.h"
#include "material/layers/field.h"
#include "material/layers/parameters.h"

// One layer on what lies below it, a parameter at a time: what a stack needs at once is two fields and a
// mask. Means are of numbers in linear space (seed 000, "Compositing"; seed 002, "Material Layering").

namespace weft::material {

enum class LayerBlend {
  kReplace,  ///< below + mask (layer - below)
  /// The layer's relief, pattern and gloss are joined to what is below and nothing else of it changes: slopes
  /// and heights less their mean, the albedo multiplied by the layer's over its mean, and the roughness that
  /// facets of the one on facets of the other have (material/filtering/joined_gloss).
  kDetail
};
const char* name_of(LayerBlend blend);
std::optional<LayerBlend> layer_blend_named(std::string_view name);

struct LayOptions {
  LayerBlend blend = LayerBlend::kReplace;
  NormalBlend normals = NormalBlend::kAddSlopes;  ///< of kDetail
  double alpha = 1;                               ///< multiplies the mask, 0 to 1
  int threads = 0;
};

/// Lays `layer` on `below` through `mask`, 1 plane, which counts from 0 to 1. Maps have one size. What is
/// the same everywhere stays so where nothing varies. kUsage for sizes or planes that differ.
///
/// kDetail leaves every parameter alone but albedo, normal, height and roughness. A mask narrows the layer's
/// lobe as it flattens its slopes. A plane of an albedo whose mean is not above 0 leaves what is below.
Result<void> lay(Parameter parameter, ParameterField& below, const ParameterField& layer,
                 const ParameterField& mask, const LayOptions& options);

/// Multiplies each plane: albedo by its tint, slopes by their scale.
void multiply(ParameterField& field, const std::array<double, 3>& factors, int threads);

/// Brings values into `least` to `most`, and says of how many that changed.
std::int64_t clamp_to(ParameterField& field, double least, double most);

}  // namespace weft::material
