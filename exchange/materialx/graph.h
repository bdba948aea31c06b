// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exchange/textured_material.h"

// The node graph of one material: a node that is asked for twice is written once. And how XML is written.

namespace weft::exchange {

/// Elements with attributes, an element a line, indented; values are escaped.
class XmlWriter {
 public:
  using Attributes = std::initializer_list<std::pair<std::string_view, std::string_view>>;

  /// Begins with the XML declaration.
  XmlWriter();
  void open(std::string_view tag, Attributes attributes);
  /// Ends the element that was opened last.
  void close();
  /// An element without children.
  void leaf(std::string_view tag, Attributes attributes);
  /// The text, once all elements are closed.
  const std::string& text() const { return text_; }

 private:
  void begin(std::string_view tag, Attributes attributes);
  std::string text_;
  std::vector<std::string> open_;
};

/// A value in a graph: a node's output, or a number where `node` is empty.
struct MtlxValue {
  std::string type;  ///< "float", "color3", "vector3"
  std::string node;
  std::vector<double> constant;

  bool is_constant() const { return node.empty(); }
};

MtlxValue mtlx_float(double value);

class MtlxGraph {
 public:
  /// Metres that an image covers, and metres that one unit of UV covers; none: an image covers one unit.
  struct Scale {
    std::array<double, 2> image_m, uv_m;
  };

  MtlxGraph(std::string name, std::optional<Scale> scale) : name_(std::move(name)), scale_(scale) {}

  const std::string& name() const { return name_; }
  /// One channel of a texture with its scale and offset.
  MtlxValue scalar(const std::string& name, const Texture& texture);
  /// The three of a colour; its scale and offset are left to the caller.
  MtlxValue color_texels(const std::string& name, const Texture& texture);
  MtlxValue vector_texels(const std::string& name, const Texture& texture);
  /// `category` of `inputs`, whose names stand before them. Constants alone are not computed.
  MtlxValue node(const std::string& name, const std::string& category, const std::string& type,
                 const std::vector<std::pair<std::string, MtlxValue>>& inputs);
  /// A node with one word: {"space", "world"}.
  MtlxValue word_node(const std::string& name, const std::string& category, const std::string& type,
                      const std::string& input, const std::string& word);
  /// value * scale + offset, by nodes where it is one.
  MtlxValue scaled(const std::string& name, const MtlxValue& value, double scale, double offset);
  /// Makes the value an output, by the name of its node with "out_" before.
  std::string output(const MtlxValue& value);

  bool is_empty() const { return nodes_.empty(); }
  void write(XmlWriter& xml) const;
  const std::vector<std::string>& files() const { return files_; }

 private:
  struct Input {
    std::string name, type, node, value, unit, color_space;
  };
  struct Node {
    std::string category, name, type;
    std::vector<Input> inputs;
  };

  MtlxValue image(const std::string& name, const std::string& type, const Texture& texture);
  MtlxValue add(Node node);

  std::string name_;
  std::optional<Scale> scale_;
  std::vector<Node> nodes_;
  std::vector<MtlxValue> outputs_;
  std::vector<std::string> files_;
};

}  // namespace weft::exchange
