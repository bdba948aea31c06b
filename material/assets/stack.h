// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "material/assets/map_set.h"
#include "material/assets/tree.h"
#include "material/layers/field.h"

namespace weft::material {

/// A material's parameters, each composed when it is asked for: its own values, layers on them, what holds
/// over all. Only the masks are kept meanwhile.
class MaterialStack {
 public:
  /// `layers`: the built material of each layer. Reads masks, and the height as far as they follow it.
  static Result<MaterialStack> open(const MaterialNode& node, std::vector<MapSet> layers, int threads);

  /// Slopes of a normal (2 planes); kAnisotropy as an axis (2 planes), which kAnisotropyDeg is a part of. Not
  /// of the kind kFactor. The same bytes for any number of threads. Errors of read_field().
  Result<ParameterField> composed(Parameter parameter) const;

  /// Where its numbers come from: of one place as it says, of several "derived", unless all are typed.
  std::string source(Parameter parameter) const;

  /// Planes R, G, B of weights of the layers at run time; without a map none.
  Result<ParameterField> weights() const;

 private:
  MaterialStack(const MaterialNode& node, std::vector<MapSet> layers, int threads)
      : node_(&node), layers_(std::move(layers)), threads_(threads) {}
  Result<ParameterField> own(Parameter parameter) const;
  Result<ParameterField> table_value(const char* table, const KeptValues& values, Parameter parameter) const;
  Result<void> lay_layer(std::size_t i, Parameter parameter, ParameterField& below) const;
  Result<void> put_over(Parameter parameter, ParameterField& field) const;
  Result<ParameterField> mask_of(std::size_t i, const ParameterField& height_mm) const;
  Result<void> find_masks();
  bool reaches(std::size_t i, Parameter parameter) const;
  bool changes(std::size_t i, Parameter parameter) const;

  const MaterialNode* node_;
  std::vector<MapSet> layers_;
  int threads_;
  std::vector<ParameterField> masks_;
};

}  // namespace weft::material
