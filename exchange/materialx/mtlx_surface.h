// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "exchange/materialx/graph.h"
#include "exchange/materialx/materialx.h"

namespace weft::exchange {

/// The inputs of one surface shader in the convention of its model, their nodes in `graph`.
class MtlxSurface {
 public:
  /// Both must outlive it.
  MtlxSurface(const TexturedMaterial& material, SurfaceModel model, MtlxGraph& graph)
      : material_(material), model_(model), graph_(graph) {}

  /// Asks the graph for the nodes; the shader is written later, below the graph.
  void prepare();
  void write(XmlWriter& xml, const std::string& name) const;
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  struct Input {
    std::string name;
    MtlxValue value;
  };

  void put(const char* open_pbr, const char* standard, const char* gltf, const MtlxValue& value);
  MtlxValue value_of(const char* name, const TexturedParameter& parameter);
  void put_base();
  void put_lobe();
  void put_reflectance();
  void put_sheen();
  void put_opacity();
  void put_frame();
  MtlxValue tangent();

  const TexturedMaterial& material_;
  SurfaceModel model_;
  MtlxGraph& graph_;
  std::vector<Input> inputs_;
  std::vector<std::string> left_out_;
};

}  // namespace weft::exchange
