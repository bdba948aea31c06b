// SPDX-License-Identifier: Apache-2.0
#include "exchange/materialx/graph.h"

#include <algorithm>

#include "core/base/text.h"
#include "exchange/document.h"

namespace weft::exchange {

XmlWriter::XmlWriter() : text_("<?xml version=\"1.0\"?>\n") {}

void XmlWriter::begin(std::string_view tag, Attributes attributes) {
  text_.append(2 * open_.size(), ' ');
  text_ += '<';
  text_ += tag;
  for (const auto& [name, value] : attributes) {
    text_ += ' ';
    text_ += name;
    text_ += "=\"" + escape_markup(value) + '"';
  }
}

void XmlWriter::open(std::string_view tag, Attributes attributes) {
  begin(tag, attributes);
  text_ += ">\n";
  open_.emplace_back(tag);
}

void XmlWriter::close() {
  const std::string tag = open_.back();
  open_.pop_back();
  text_.append(2 * open_.size(), ' ');
  text_ += "</" + tag + ">\n";
}

void XmlWriter::leaf(std::string_view tag, Attributes attributes) {
  begin(tag, attributes);
  text_ += " />\n";
}

MtlxValue mtlx_float(double value) {
  return {"float", "", {value}};
}

MtlxValue MtlxGraph::add(Node node) {
  MtlxValue value = {node.type, node.name, {}};
  const bool is_there = std::ranges::any_of(nodes_, [&](const Node& each) { return each.name == node.name; });
  if (!is_there) nodes_.push_back(std::move(node));
  return value;
}

MtlxValue MtlxGraph::image(const std::string& name, const std::string& type, const Texture& texture) {
  if (std::ranges::find(files_, texture.file) == files_.end()) files_.push_back(texture.file);
  Node node = {"tiledimage", "image_" + name, type, {}};
  node.inputs.push_back({"file", "filename", "", texture.file, "", texture.is_srgb ? "srgb_texture" : ""});
  node.inputs.push_back({"uvtiling", "vector2", "", "1, 1", "", ""});
  if (scale_) {
    node.inputs.push_back({"realworldimagesize", "vector2", "",
                           numbers_text({scale_->image_m[0], scale_->image_m[1]}), "meter", ""});
    node.inputs.push_back(
        {"realworldtilesize", "vector2", "", numbers_text({scale_->uv_m[0], scale_->uv_m[1]}), "meter", ""});
  }
  return add(std::move(node));
}

MtlxValue MtlxGraph::scalar(const std::string& name, const Texture& texture) {
  MtlxValue value;
  if (texture.channels == "r") {
    value = image(name, "float", texture);
  } else {
    const bool is_alpha = texture.channels == "a";
    const std::string type = is_alpha ? "vector4" : "vector3";
    const int index = is_alpha ? 3 : texture.channels == "g" ? 1 : 2;
    value = node("channel_" + name, "extract", "float",
                 {{"in", image(name, type, texture)}, {"index", {"integer", "", {double(index)}}}});
  }
  return scaled(name, value, texture.scale, texture.offset);
}

MtlxValue MtlxGraph::color_texels(const std::string& name, const Texture& texture) {
  return image(name, "color3", texture);
}

MtlxValue MtlxGraph::vector_texels(const std::string& name, const Texture& texture) {
  return image(name, "vector3", texture);
}

MtlxValue MtlxGraph::node(const std::string& name, const std::string& category, const std::string& type,
                          const std::vector<std::pair<std::string, MtlxValue>>& inputs) {
  Node node = {category, name, type, {}};
  for (const auto& [input, value] : inputs) {
    const bool is_constant = value.is_constant();
    node.inputs.push_back(
        {input, value.type, value.node, is_constant ? numbers_text(value.constant) : "", "", ""});
  }
  return add(std::move(node));
}

MtlxValue MtlxGraph::word_node(const std::string& name, const std::string& category, const std::string& type,
                               const std::string& input, const std::string& word) {
  return add({category, name, type, {{input, "string", "", word, "", ""}}});
}

MtlxValue MtlxGraph::scaled(const std::string& name, const MtlxValue& value, double scale, double offset) {
  MtlxValue scaled = value;
  if (value.is_constant()) {
    for (double& each : scaled.constant) each = each * scale + offset;
    return scaled;
  }
  if (scale != 1) {
    scaled = node("scaled_" + name, "multiply", value.type, {{"in1", scaled}, {"in2", mtlx_float(scale)}});
  }
  if (offset != 0) {
    scaled = node("moved_" + name, "add", value.type, {{"in1", scaled}, {"in2", mtlx_float(offset)}});
  }
  return scaled;
}

std::string MtlxGraph::output(const MtlxValue& value) {
  const bool is_there =
      std::ranges::any_of(outputs_, [&](const MtlxValue& each) { return each.node == value.node; });
  if (!is_there) outputs_.push_back(value);
  return "out_" + value.node;
}

void MtlxGraph::write(XmlWriter& xml) const {
  if (nodes_.empty()) return;
  xml.open("nodegraph", {{"name", name_}});
  for (const Node& node : nodes_) {
    xml.open(node.category, {{"name", node.name}, {"type", node.type}});
    for (const Input& input : node.inputs) {
      if (!input.node.empty()) {
        xml.leaf("input", {{"name", input.name}, {"type", input.type}, {"nodename", input.node}});
      } else if (!input.unit.empty()) {
        xml.leaf("input", {{"name", input.name},
                           {"type", input.type},
                           {"value", input.value},
                           {"unittype", "distance"},
                           {"unit", input.unit}});
      } else if (!input.color_space.empty()) {
        xml.leaf("input", {{"name", input.name},
                           {"type", input.type},
                           {"value", input.value},
                           {"colorspace", input.color_space}});
      } else {
        xml.leaf("input", {{"name", input.name}, {"type", input.type}, {"value", input.value}});
      }
    }
    xml.close();
  }
  for (const MtlxValue& value : outputs_) {
    xml.leaf("output", {{"name", "out_" + value.node}, {"type", value.type}, {"nodename", value.node}});
  }
  xml.close();
}

}  // namespace weft::exchange
