// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exchange/document.h"

// USD's text, a line at a time.

namespace weft::exchange {

/// "a \"b\"" with its quotes.
std::string usda_string(std::string_view text);
/// An asset path between its marks.
std::string usda_asset(std::string_view path);
/// "(1, 2, 3)".
std::string usda_tuple(const std::vector<double>& values);

class UsdaWriter {
 public:
  void line(const std::string& text) { text_ += std::string(4 * depth_, ' ') + text + "\n"; }
  void blank() { text_ += "\n"; }
  /// `head`, and a block in braces that end_block() ends.
  void begin_block(const std::string& head) {
    line(head);
    line("{");
    ++depth_;
  }
  void end_block() {
    --depth_;
    line("}");
  }
  /// `head` ends with the bracket that `end` answers.
  void begin_list(const std::string& head) {
    line(head);
    ++depth_;
  }
  void end_list(const std::string& end) {
    --depth_;
    line(end);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t depth_ = 0;
};

/// The material's prim with its shaders, at `path` ("/cloth/Looks/cloth"). Files and what is left out are
/// added to `document`.
void write_usda_material(UsdaWriter& usda, const TexturedMaterial& material, const std::string& path,
                         const std::string& materialx_file, Document& document);

}  // namespace weft::exchange
