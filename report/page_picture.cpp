// SPDX-License-Identifier: Apache-2.0
#include "report/page_picture.h"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "core/text.h"

namespace weft::report {
namespace {

// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      out += i + j <= bytes.size() ? kDigits[group >> (18 - 6 * j) & 63U] : '=';
    }
  }
  return out;
}

}  // namespace

std::string picture_row(const std::vector<PagePicture>& pictures) {
  if (pictures.empty()) return "";
  std::string body = "<div class=\"pictures\">\n";
  for (const PagePicture& p : pictures) {
    body += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        escape_markup(p.label), base64(p.png));
  }
  return "<section>" + body + "</div></section>\n";
}

}  // namespace weft::report
