// SPDX-License-Identifier: Apache-2.0
#include "exchange/materialx/xml.h"

#include "core/base/text.h"

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

}  // namespace weft::exchange
