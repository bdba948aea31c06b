// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "exchange/materialx/graph.h"
#include "exchange/materialx/materialx.h"

// What documents of one material and of several have in common.

namespace weft::exchange {

Result<void> check_materialx_options(const MaterialXOptions& options, bool has_size);
std::optional<MtlxGraph::Scale> scale_of(const TexturedMaterial& material,
                                         const std::optional<std::array<double, 2>>& uv_covers_mm);
std::string size_note_of(const TexturedMaterial& material);

/// The root element; it is closed by the caller.
void open_document(XmlWriter& xml, const std::string& name,
                   const std::vector<std::pair<std::string, std::string>>& provenance,
                   const std::string& size_note);
/// `displacement`: the name of a node, or empty.
void write_material(XmlWriter& xml, const std::string& name, const std::string& shader,
                    const std::string& displacement);
/// Millimetres of the graph as a displacement in metres; returns the name of the node.
std::string write_displacement(XmlWriter& xml, const MtlxGraph& graph, const MtlxValue& height);

}  // namespace weft::exchange
