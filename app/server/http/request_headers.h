// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace weft::app {

/// Whether the value of an If-None-Match header names this tag, which stands without its quotes, or any (*).
/// Tags are compared weakly (RFC 9110, 8.8.3.2). False for what is no list of tags.
bool names_tag(std::string_view header, std::string_view tag);

/// Whether the value of an Accept-Encoding header names this coding with a weight above 0 (RFC 9110, 12.5.3).
bool takes_coding(std::string_view header, std::string_view coding);

/// What of `size` bytes the value of a Range header asks for.
struct AskedRange {
  enum class Is {
    kWhole,   ///< all: no range, one in other units, several, or none that can be read (RFC 9110, 14.2)
    kPart,    ///< `bytes` from `first` on, at least one
    kBeyond,  ///< a range that has none of these bytes
  };
  Is is = Is::kWhole;
  std::uint64_t first = 0, bytes = 0;
};
AskedRange asked_range(std::string_view header, std::uint64_t size);

}  // namespace weft::app
