// SPDX-License-Identifier: Apache-2.0
#include "tests/exchange/materialx/mtlx_reader.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <stdexcept>

namespace weft::exchange {

namespace {

std::string unescaped(std::string text) {
  for (const auto& [from, to] :
       {std::pair("&lt;", "<"), {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}}) {
    text = std::regex_replace(text, std::regex(from), to);
  }
  return text;
}

double value_of_node(const XmlElement& graph, const std::string& name,
                     const std::map<std::string, double>& texels) {
  const XmlElement* node = graph.child(name);
  if (node == nullptr) throw std::runtime_error("no node " + name);
  const auto in = [&](const char* input) {
    const XmlElement* found = node->child(input);
    if (found == nullptr) throw std::runtime_error(name + " has no input " + input);
    const std::string from = found->at("nodename");
    return from.empty() ? std::stod(found->at("value")) : value_of_node(graph, from, texels);
  };
  if (node->tag == "tiledimage") return texels.at(name);
  if (node->tag == "extract" || node->tag == "convert") return in("in");
  if (node->tag == "multiply") return in("in1") * in("in2");
  if (node->tag == "divide") return in("in1") / in("in2");
  if (node->tag == "add") return in("in1") + in("in2");
  if (node->tag == "subtract") return in("in1") - in("in2");
  if (node->tag == "max") return std::max(in("in1"), in("in2"));
  if (node->tag == "sqrt") return std::sqrt(in("in"));
  if (node->tag == "mix") return in("bg") * (1 - in("mix")) + in("fg") * in("mix");
  throw std::runtime_error("no rule for " + node->tag);
}

}  // namespace

std::string XmlElement::at(const std::string& name) const {
  const auto found = attributes.find(name);
  return found == attributes.end() ? "" : found->second;
}

const XmlElement* XmlElement::child(const std::string& name) const {
  const auto found =
      std::ranges::find_if(children, [&](const XmlElement& each) { return each.at("name") == name; });
  return found == children.end() ? nullptr : &*found;
}

XmlElement read_xml(const std::string& text) {
  const std::regex element("<(/?)([\\w?]+)((?:\\s+\\w+=\"[^\"<>]*\")*)\\s*([/?]?)>\\s*");
  const std::regex attribute("(\\w+)=\"([^\"]*)\"");
  std::vector<XmlElement> open = {{"", {}, {}}};
  auto at = text.cbegin();
  for (std::smatch match; at != text.cend(); at = match[0].second) {
    if (!std::regex_search(at, text.cend(), match, element, std::regex_constants::match_continuous)) {
      throw std::runtime_error("no element at: " + std::string(at, std::min(at + 60, text.cend())));
    }
    if (match[4] == "?") continue;
    if (match[1] == "/") {
      if (open.size() < 2 || open.back().tag != match[2]) throw std::runtime_error("closed: " + match.str(2));
      XmlElement done = std::move(open.back());
      open.pop_back();
      open.back().children.push_back(std::move(done));
      continue;
    }
    XmlElement next = {match[2], {}, {}};
    const std::string attributes = match[3];
    for (auto it = std::sregex_iterator(attributes.begin(), attributes.end(), attribute);
         it != std::sregex_iterator(); ++it) {
      if (!next.attributes.emplace((*it)[1], unescaped((*it)[2])).second) throw std::runtime_error("twice");
    }
    (match[4] == "/" ? open.back().children : open).push_back(std::move(next));
  }
  if (open.size() != 1 || open[0].children.size() != 1) throw std::runtime_error("an element is open");
  return open[0].children[0];
}

double value_of_input(const XmlElement& document, const std::string& shader, const std::string& input,
                      const std::map<std::string, double>& texels) {
  const XmlElement* surface = document.child(shader);
  const XmlElement* found = surface == nullptr ? nullptr : surface->child(input);
  if (found == nullptr) throw std::runtime_error(shader + " has no " + input);
  if (!found->at("value").empty()) return std::stod(found->at("value"));
  const XmlElement* graph = document.child(found->at("nodegraph"));
  const XmlElement* output = graph == nullptr ? nullptr : graph->child(found->at("output"));
  if (output == nullptr) throw std::runtime_error(input + " is connected to nothing");
  return value_of_node(*graph, output->at("nodename"), texels);
}

}  // namespace weft::exchange
