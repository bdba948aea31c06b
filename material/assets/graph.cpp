// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <set>
#include <string>

#include "material/assets/tree.h"

namespace weft::material {
namespace {

// A text of Graphviz in its quotes.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

}  // namespace

std::string graph_of(const MaterialTree& tree) {
  std::string boxes, arrows;
  std::set<std::string> drawn, said;
  const auto box = [&](const std::string& place, const std::string& label, const char* shape) {
    if (drawn.insert(place).second)
      boxes += fmt::format("  {} [shape={}, label={}];\n", quoted(place), shape, quoted(label));
  };
  const auto arrow = [&](const std::string& from, const std::string& to, const std::string& label,
                         const char* style) {
    const std::string line =
        fmt::format("  {} -> {} [label={}, style={}];\n", quoted(from), quoted(to), quoted(label), style);
    if (said.insert(line).second) arrows += line;
  };
  for (const MaterialNode& node : tree.nodes) box(node.material.place.name, node.name + " " + node.id, "box");
  for (const MaterialNode& node : tree.nodes) {
    const ResolvedMaterial& material = node.material;
    for (std::size_t i = 1; i < material.generations.size(); ++i) {
      box(material.generations[i].name, material.generations[i].name, "box");
      arrow(material.generations[i].name, material.generations[i - 1].name, "inherits", "dashed");
    }
    for (std::size_t i = 0; i < node.layers.size(); ++i)
      arrow(tree.nodes[node.layers[i]].material.place.name, material.place.name, material.layers[i].name,
            "solid");
    for (std::size_t i = 0; i < node.runtime.size(); ++i)
      arrow(tree.nodes[node.runtime[i]].material.place.name, material.place.name,
            "runtime " + material.runtime_layers[i].name, "dotted");
    for (const auto& [key, map] : node.maps) {
      if (map.file.empty()) continue;
      box(map.file.string(), map.file.filename().string(), "ellipse");
      arrow(map.file.string(), material.place.name, key, "solid");
    }
  }
  return "digraph materials {\n  rankdir=LR;\n" + boxes + arrows + "}\n";
}

}  // namespace weft::material
