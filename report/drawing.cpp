// SPDX-License-Identifier: Apache-2.0
#include "report/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace weft::report {
namespace {

constexpr int kAdvance = 6;

struct GlyphRow {
  std::u32string_view characters;
  std::array<std::string_view, kGlyphHeight> pixels;
};

// clang-format off
constexpr std::array<GlyphRow, 4> kFont = {{
    {U"ABCDEFGHIJKLM",
     {".###. ####. .###. ####. ##### ##### .###. #...# .###. ..### #...# #.... #...#",
      "#...# #...# #...# #...# #.... #.... #...# #...# ..#.. ...#. #..#. #.... ##.##",
      "#...# #...# #.... #...# #.... #.... #.... #...# ..#.. ...#. #.#.. #.... #.#.#",
      "##### ####. #.... #...# ####. ####. #.### ##### ..#.. ...#. ##... #.... #.#.#",
      "#...# #...# #.... #...# #.... #.... #...# #...# ..#.. ...#. #.#.. #.... #...#",
      "#...# #...# #...# #...# #.... #.... #...# #...# ..#.. #..#. #..#. #.... #...#",
      "#...# ####. .###. ####. ##### #.... .###. #...# .###. .##.. #...# ##### #...#"}},
    {U"NOPQRSTUVWXYZ",
     {"#...# .###. ####. .###. ####. .#### ##### #...# #...# #...# #...# #...# #####",
      "##..# #...# #...# #...# #...# #.... ..#.. #...# #...# #...# #...# #...# ....#",
      "##..# #...# #...# #...# #...# #.... ..#.. #...# #...# #...# .#.#. .#.#. ...#.",
      "#.#.# #...# ####. #...# ####. .###. ..#.. #...# #...# #.#.# ..#.. ..#.. ..#..",
      "#..## #...# #.... #.#.# #.#.. ....# ..#.. #...# #...# #.#.# .#.#. ..#.. .#...",
      "#..## #...# #.... #..#. #..#. ....# ..#.. #...# .#.#. #.#.# #...# ..#.. #....",
      "#...# .###. #.... .##.# #...# ####. ..#.. .###. ..#.. .#.#. #...# ..#.. #####"}},
    {U"0123456789.,:",
     {".###. ..#.. .###. .###. ...#. ##### .###. ##### .###. .###. ..... ..... .....",
      "#...# .##.. #...# #...# ..##. #.... #.... ....# #...# #...# ..... ..... .##..",
      "#..## ..#.. ....# ....# .#.#. ####. #.... ...#. #...# #...# ..... ..... .##..",
      "#.#.# ..#.. ...#. ..##. #..#. ....# ####. ..#.. .###. .#### ..... ..... .....",
      "##..# ..#.. ..#.. ....# ##### ....# #...# ..#.. #...# ....# ..... .##.. .##..",
      "#...# ..#.. .#... #...# ...#. #...# #...# ..#.. #...# ....# .##.. ..#.. .##..",
      ".###. .###. ##### .###. ...#. .###. .###. ..#.. .###. .###. .##.. .#... ....."}},
    {U"-+=/()%_<>°×?",
     {"..... ..... ..... ....# ...#. .#... ##..# ..... ...#. .#... .##.. ..... .###.",
      "..... ..#.. ..... ....# ..#.. ..#.. ##..# ..... ..#.. ..#.. #..#. #...# #...#",
      "..... ..#.. ##### ...#. .#... ...#. ...#. ..... .#... ...#. #..#. .#.#. ....#",
      ".###. ##### ..... ..#.. .#... ...#. ..#.. ..... #.... ....# .##.. ..#.. ...#.",
      "..... ..#.. ##### .#... .#... ...#. .#... ..... .#... ...#. ..... .#.#. ..#..",
      "..... ..#.. ..... #.... ..#.. ..#.. #..## ..... ..#.. ..#.. ..... #...# .....",
      "..... ..... ..... #.... ...#. .#... #..## ##### ...#. .#... ..... ..... ..#.."}}}};
// clang-format on

/// The next character of a UTF-8 text, which must not be empty; letters become capitals.
char32_t take_character(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  const std::string_view bytes = text.substr(0, length);
  text.remove_prefix(bytes.size());
  if (bytes.size() == 2) return (char32_t{first} & 0x1F) << 6 | (static_cast<unsigned char>(bytes[1]) & 0x3F);
  if (bytes.size() > 2) return U'?';
  return first >= 'a' && first <= 'z' ? char32_t{first} - 'a' + 'A' : char32_t{first};
}

bool glyph_has(char32_t character, int x, int y) {
  if (character == U' ') return false;
  for (const GlyphRow& row : kFont) {
    const std::size_t at = row.characters.find(character);
    if (at == row.characters.npos) continue;
    return row.pixels[static_cast<std::size_t>(y)][at * kAdvance + static_cast<std::size_t>(x)] == '#';
  }
  return glyph_has(U'?', x, y);
}

}  // namespace

std::string css_colour(Colour c) {
  const auto byte = [](float v) { return static_cast<int>(std::lround(255 * std::clamp(v, 0.0F, 1.0F))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

Picture blank_picture(Size size, Colour colour) {
  Picture picture(size, 3);
  fill(picture, {0, 0, size.width, size.height}, colour);
  return picture;
}

Colour colour_at(const Picture& picture, int x, int y) {
  return {picture(x, y, 0), picture(x, y, 1), picture(x, y, 2)};
}

void fill(Picture& picture, Rect area, Colour colour) {
  const int x0 = std::max(area.x0, 0), x1 = std::min(area.x1, picture.width());
  const int y0 = std::max(area.y0, 0), y1 = std::min(area.y1, picture.height());
  const std::array<float, 3> values = {colour.r, colour.g, colour.b};
  for (int p = 0; p < 3; ++p) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) picture(x, y, p) = values[static_cast<std::size_t>(p)];
    }
  }
}

void paste(Picture& picture, int x, int y, const Picture& what) {
  for (int v = std::max(0, -y); v < std::min(what.height(), picture.height() - y); ++v) {
    for (int u = std::max(0, -x); u < std::min(what.width(), picture.width() - x); ++u) {
      for (int p = 0; p < 3; ++p) picture(x + u, y + v, p) = what(u, v, p);
    }
  }
}

int text_width(std::string_view text, int scale) {
  int characters = 0;
  for (; !text.empty(); ++characters) take_character(text);
  return std::max(0, characters * kAdvance - 1) * scale;
}

void draw_text(Picture& picture, int x, int y, std::string_view text, Colour ink, int scale) {
  for (; !text.empty(); x += kAdvance * scale) {
    const char32_t character = take_character(text);
    for (int v = 0; v < kGlyphHeight; ++v) {
      for (int u = 0; u < kAdvance - 1; ++u) {
        const int left = x + u * scale, top = y + v * scale;
        if (glyph_has(character, u, v)) fill(picture, {left, top, left + scale, top + scale}, ink);
      }
    }
  }
}

std::string text_within(std::string_view text, int width, int scale) {
  if (text_width(text, scale) <= width) return std::string(text);
  std::string cut;
  while (text_width(cut + "..", scale) + kAdvance * scale <= width) {
    const std::string_view before = text;
    take_character(text);
    cut += before.substr(0, before.size() - text.size());
  }
  return cut + "..";
}

int text_scale_for(int width) {
  return std::clamp(width / 320, 1, 4);
}

Picture contact_sheet(std::string_view title, std::span<const Panel> panels, int columns) {
  const int count = static_cast<int>(panels.size());
  if (columns <= 0) columns = static_cast<int>(std::ceil(std::sqrt(count)));
  columns = std::clamp(columns, 1, std::max(1, count));

  int cell_width = 0;
  for (const Panel& panel : panels) cell_width = std::max(cell_width, panel.picture.width());
  const int scale = text_scale_for(cell_width), title_scale = scale + 1;
  const int line = kGlyphHeight * scale, gap = 4 * scale, margin = 8 * scale;
  const int label_height = 2 * (line + gap);

  // Every row is as high as its highest picture.
  std::vector<int> tops = {margin + kGlyphHeight * title_scale + 2 * margin};
  for (int i = 0; i < count; i += columns) {
    int height = 0;
    for (int k = i; k < std::min(i + columns, count); ++k) {
      height = std::max(height, panels[static_cast<std::size_t>(k)].picture.height());
    }
    tops.push_back(tops.back() + label_height + height + 2 * margin);
  }
  const int width = std::max(margin + columns * (cell_width + margin), 40 * kAdvance * title_scale);
  Picture sheet = blank_picture({width, tops.back()});
  draw_text(sheet, margin, margin, text_within(title, width - 2 * margin, title_scale), kInk, title_scale);
  for (int i = 0; i < count; ++i) {
    const Panel& panel = panels[static_cast<std::size_t>(i)];
    const int x = margin + i % columns * (cell_width + margin);
    const int y = tops[static_cast<std::size_t>(i / columns)];
    draw_text(sheet, x, y, text_within(panel.label, cell_width, scale), kInk, scale);
    draw_text(sheet, x, y + line + gap, text_within(panel.note, cell_width, scale), kFaintInk, scale);
    paste(sheet, x, y + label_height, panel.picture);
  }
  return sheet;
}

}  // namespace weft::report
