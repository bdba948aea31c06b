// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

}  // namespace weft::exchange
