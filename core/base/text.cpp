// SPDX-License-Identifier: Apache-2.0
#include "core/base/text.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace weft {
namespace {

// What is beyond ASCII and neither letter, digit nor mark (Unicode 14), up to rare signs of single scripts.
struct Codes {
  char32_t first, last;
};
constexpr std::array<Codes, 75> kNoLetters = {
    {{0x80, 0xA9},       {0xAB, 0xB4},       {0xB6, 0xB9},       {0xBB, 0xBF},       {0xD7, 0xD7},
     {0xF7, 0xF7},       {0x2C2, 0x2C5},     {0x2D2, 0x2DF},     {0x2E5, 0x2EB},     {0x2ED, 0x2ED},
     {0x2EF, 0x2FF},     {0x375, 0x375},     {0x37E, 0x37E},     {0x384, 0x385},     {0x387, 0x387},
     {0x3F6, 0x3F6},     {0x482, 0x482},     {0x55A, 0x55F},     {0x589, 0x58F},     {0x5BE, 0x5BE},
     {0x5C0, 0x5C0},     {0x5C3, 0x5C3},     {0x5C6, 0x5C6},     {0x5F3, 0x5F4},     {0x600, 0x60F},
     {0x61B, 0x61F},     {0x66A, 0x66D},     {0x6D4, 0x6D4},     {0x6DD, 0x6DE},     {0x6E9, 0x6E9},
     {0x6FD, 0x6FE},     {0x700, 0x70F},     {0x7F6, 0x7F9},     {0x890, 0x891},     {0x8E2, 0x8E2},
     {0x964, 0x965},     {0x970, 0x970},     {0xE3F, 0xE3F},     {0xE4F, 0xE4F},     {0xE5A, 0xE5B},
     {0xF01, 0xF17},     {0xF3A, 0xF3D},     {0x1680, 0x1680},   {0x1800, 0x180A},   {0x180E, 0x180E},
     {0x2000, 0x2BFF},   {0x2E00, 0x2E7F},   {0x2FF0, 0x3004},   {0x3008, 0x3020},   {0x3030, 0x3030},
     {0x3036, 0x3037},   {0x303D, 0x3040},   {0x309B, 0x309C},   {0x30A0, 0x30A0},   {0x30FB, 0x30FB},
     {0x31C0, 0x31EF},   {0x3200, 0x33FF},   {0x4DC0, 0x4DFF},   {0xA490, 0xA4CF},   {0xA4FE, 0xA4FF},
     {0xE000, 0xF8FF},   {0xFD3E, 0xFD4F},   {0xFDC8, 0xFDEF},   {0xFDFC, 0xFE1F},   {0xFE30, 0xFE6F},
     {0xFEFF, 0xFF0F},   {0xFF1A, 0xFF20},   {0xFF3B, 0xFF40},   {0xFF5B, 0xFF65},   {0xFFE0, 0xFFFF},
     {0x10100, 0x1013F}, {0x1D000, 0x1D3FF}, {0x1EC70, 0x1ECBF}, {0x1F000, 0x1FBEF}, {0xE0000, 0x10FFFF}}};

struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
};

// The first of a text that is not empty. Bytes that are no UTF-8 are taken one by one, as the code 0.
Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  constexpr std::array<char32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  if (lead < 0xC2 || lead > 0xF4 || bytes > text.size()) return {};
  char32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3FU);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < kLeast[bytes] || is_surrogate ? Character{} : Character{code, bytes};
}

bool stays(const Character& character) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  const char32_t code = character.code;
  if (code < 0x80) return kPlain.find(static_cast<char>(code)) != kPlain.npos;
  return std::ranges::none_of(
      kNoLetters, [code](const Codes& codes) { return code >= codes.first && code <= codes.last; });
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

char small_letter(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// A run of digits at the front of `text`, which it is taken from, without leading zeros.
std::string_view take_number(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && is_digit(text[end])) ++end;
  std::string_view number = text.substr(0, end);
  text.remove_prefix(end);
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

}  // namespace

std::string small_letters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), small_letter);
  return small;
}

bool stands_before(std::string_view a, std::string_view b) {
  std::string_view left = a, right = b;
  while (!left.empty() && !right.empty()) {
    if (is_digit(left[0]) && is_digit(right[0])) {
      const std::string_view m = take_number(left), n = take_number(right);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
      continue;
    }
    if (small_letter(left[0]) != small_letter(right[0])) {
      return static_cast<unsigned char>(small_letter(left[0])) <
             static_cast<unsigned char>(small_letter(right[0]));
    }
    left.remove_prefix(1);
    right.remove_prefix(1);
  }
  if (left.empty() != right.empty()) return left.empty();
  return a < b;
}

std::string first_few(const std::vector<std::string>& names, std::size_t count) {
  constexpr std::size_t kShown = 3;
  count = std::max(count, names.size());
  const std::size_t shown = std::min(names.size(), count == kShown + 1 ? count : kShown);
  std::string words;
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) words += i + 1 == count ? " and " : ", ";
    words += names[i];
  }
  return shown == count ? words : words + " and " + std::to_string(count - shown) + " more";
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::string plain_name(std::string text) {
  std::string plain;
  for (std::string_view rest = text; !rest.empty();) {
    const Character next = first_character(rest);
    plain += stays(next) ? rest.substr(0, next.bytes) : "-";
    rest.remove_prefix(next.bytes);
  }
  return plain;
}

std::string file_name_of(std::string_view text, std::string_view otherwise, std::size_t most_bytes) {
  std::string name;
  const std::string plain = plain_name(std::string(text));
  for (std::string_view rest = plain; !rest.empty();) {
    const std::size_t bytes = first_character(rest).bytes;
    if (name.size() + bytes > most_bytes) break;
    const bool is_more_of_a_gap = rest.front() == '-' && (name.empty() || name.back() == '-');
    if (!is_more_of_a_gap && !(name.empty() && rest.front() == '.')) name += rest.substr(0, bytes);
    rest.remove_prefix(bytes);
  }
  while (name.ends_with('-') || name.ends_with('.')) name.pop_back();
  return name.empty() ? std::string(otherwise) : name;
}

std::string escape_markup(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace weft
