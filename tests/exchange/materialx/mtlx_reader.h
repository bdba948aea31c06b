// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

namespace weft::exchange {

/// An element of XML, read by a reader of a few lines: elements and attributes, no text.
struct XmlElement {
  std::string tag;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;

  std::string at(const std::string& name) const;
  /// The child `tag` with this name, or null.
  const XmlElement* child(const std::string& name) const;
};

/// Throws std::runtime_error where elements do not nest.
XmlElement read_xml(const std::string& text);

/// The value that an input of a shader has, its graph evaluated with `texels` by the names of images: floats,
/// the first channel of vectors and colours. Throws for a category that it does not know.
double value_of_input(const XmlElement& document, const std::string& shader, const std::string& input,
                      const std::map<std::string, double>& texels);

}  // namespace weft::exchange
