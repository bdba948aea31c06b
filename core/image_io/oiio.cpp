// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/oiio.h"

namespace weft {

void prepare_oiio() {
  // Debian builds it with debug messages on.
  static const bool prepared = OIIO::attribute("debug", 0);
  static_cast<void>(prepared);
}

std::string oiio_reason(const std::string& message) {
  const std::size_t end = message.find('\n');
  std::string line = message.substr(0, end);
  while (!line.empty() && (line.back() == '.' || line.back() == ' ')) line.pop_back();
  return line.empty() ? "the file format library gives no reason" : line;
}

}  // namespace weft
