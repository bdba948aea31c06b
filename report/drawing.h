// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/image/image.h"

namespace weft::report {

/// A picture for people: planes R, G, B of display values in [0, 1], sRGB-encoded, as an 8-bit PNG keeps
/// them.
using Picture = Image<float>;

/// A display colour, sRGB-encoded.
struct Colour {
  float r = 0, g = 0, b = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};
/// "#rrggbb"
std::string css_colour(Colour colour);

inline constexpr Colour kBackground{0.11f, 0.11f, 0.12f};
inline constexpr Colour kInk{0.92f, 0.92f, 0.90f};
inline constexpr Colour kFaintInk{0.62f, 0.62f, 0.62f};

Picture blank_picture(Size size, Colour colour = kBackground);
Colour colour_at(const Picture& picture, int x, int y);

// Whatever lies outside a picture is not drawn.
void fill(Picture& picture, Rect area, Colour colour);
void paste(Picture& picture, int x, int y, const Picture& what);

/// Glyphs are 5 x 7 pixels, one every 6, `scale` times enlarged. Letters are drawn as capitals; beyond
/// letters and digits there are . , : - + = / ( ) % _ < > and, in UTF-8, the signs of degree and
/// multiplication; any other is drawn as a question mark.
inline constexpr int kGlyphHeight = 7;
int text_width(std::string_view text, int scale);
void draw_text(Picture& picture, int x, int y, std::string_view text, Colour ink, int scale);
/// The text, cut with two dots at its end if it is wider than `width`.
std::string text_within(std::string_view text, int width, int scale);
/// How large text is on something this wide, so that a 1024 pixel preview can be read on a screen.
int text_scale_for(int width);

/// A picture on a contact sheet.
struct Panel {
  std::string label;
  std::string note;  ///< a second, fainter line: a scale or a mean
  Picture picture;
};

/// All panels in a grid on a dark background, each below its label; `columns` 0 makes the grid about square.
Picture contact_sheet(std::string_view title, std::span<const Panel> panels, int columns = 0);

}  // namespace weft::report
