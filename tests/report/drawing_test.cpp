// SPDX-License-Identifier: Apache-2.0
#include "report/drawing.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace weft::report {
namespace {

constexpr Colour kBlack{0, 0, 0}, kWhite{1, 1, 1};

/// A picture as rows of '#' for white and '.' for black.
std::vector<std::string> rows_of(const Picture& picture) {
  std::vector<std::string> rows;
  for (int y = 0; y < picture.height(); ++y) {
    std::string row;
    for (int x = 0; x < picture.width(); ++x) row += colour_at(picture, x, y) == kWhite ? '#' : '.';
    rows.push_back(row);
  }
  return rows;
}

std::vector<std::string> drawn(std::string_view text) {
  Picture picture = blank_picture({text_width(text, 1), kGlyphHeight}, kBlack);
  draw_text(picture, 0, 0, text, kWhite, 1);
  return rows_of(picture);
}

TEST(CssColour, RoundsToBytesAndHoldsToTheirRange) {
  EXPECT_EQ(css_colour({0, 0.5F, 1}), "#0080ff");
  EXPECT_EQ(css_colour({-1, 2, 1 / 255.0F}), "#00ff01");
}

TEST(Drawing, WritesTextAsItsGlyphs) {
  const std::vector<std::string> wanted = {
      "#...#.#####........###........#####..##..",  //
      "#...#.#...........#...#.......#.....#..#.", "#...#.#...........#..##.......####..#..#.",
      "#.#.#.####........#.#.#...........#..##..", "#.#.#.#...........##..#...........#......",
      "#.#.#.#...........#...#..##...#...#......", ".#.#..#####........###...##....###......."};
  EXPECT_EQ(drawn("We 0.5°"), wanted);
}

TEST(Drawing, HasADifferentGlyphForEveryCharacter) {
  std::set<std::vector<std::string>> glyphs;
  const std::vector<std::string> characters = {
      "A", "B", "C", "D", "E", "F", "G", "H", "I", "J", "K", "L", "M", "N", "O", "P", "Q", "R",
      "S", "T", "U", "V", "W", "X", "Y", "Z", "0", "1", "2", "3", "4", "5", "6", "7", "8", "9",
      ".", ",", ":", "-", "+", "=", "/", "(", ")", "%", "_", "<", ">", "°", "×", " "};
  for (const std::string& character : characters)
    EXPECT_TRUE(glyphs.insert(drawn(character)).second) << character;
  EXPECT_FALSE(glyphs.contains(drawn("?")));
}

TEST(Drawing, DrawsWhatItDoesNotKnowAsQuestionMarks) {
  EXPECT_EQ(drawn("\xe2\x82\xac"), drawn("?"));      // three bytes of UTF-8
  EXPECT_EQ(drawn("\xf0\x9f\xa7\xb5"), drawn("?"));  // four
  EXPECT_EQ(drawn("\xc3\xa9;"), drawn("??"));        // two, and an unknown sign
  EXPECT_EQ(drawn("\xc2"), drawn("?"));              // cut short
  EXPECT_EQ(drawn("\n\x01"), drawn("??"));
}

TEST(Drawing, EnlargesGlyphsToSquares) {
  Picture picture = blank_picture({text_width("7", 3), 3 * kGlyphHeight}, kBlack);
  draw_text(picture, 0, 0, "7", kWhite, 3);
  const std::vector<std::string> small = drawn("7"), large = rows_of(picture);
  for (std::size_t y = 0; y < large.size(); ++y) {
    for (std::size_t x = 0; x < large[y].size(); ++x)
      ASSERT_EQ(large[y][x], small[y / 3][x / 3]) << x << ", " << y;
  }
}

TEST(Drawing, StaysInsideThePicture) {
  Picture picture = blank_picture({8, 6}, kBlack);
  const Picture patch = blank_picture({5, 5}, kWhite);
  draw_text(picture, -3, -2, "WEFT", kWhite, 2);
  fill(picture, {-5, -5, 3, 100}, kWhite);
  paste(picture, 6, 4, patch);
  paste(picture, -4, -4, patch);
  paste(picture, 100, 100, patch);
  EXPECT_EQ(colour_at(picture, 7, 5), kWhite);
  EXPECT_EQ(colour_at(picture, 0, 0), kWhite);
}

TEST(Drawing, CutsTextThatIsTooWide) {
  EXPECT_EQ(text_within("NORMAL", text_width("NORMAL", 2), 2), "NORMAL");
  EXPECT_EQ(text_within("NORMAL", text_width("NORMAL", 2) - 1, 2), "NOR..");
  EXPECT_LE(text_width(text_within("°°°°°°°°", 30, 1), 1), 30);
  EXPECT_EQ(text_within("NORMAL", 0, 1), "..");
}

TEST(ContactSheet, ShowsEveryPictureWholeUnderItsLabel) {
  std::vector<Panel> panels;
  for (int i = 0; i < 5; ++i) {
    const float level = 0.2f + 0.1f * static_cast<float>(i);
    panels.push_back({"panel", "note", blank_picture({30 + 10 * i, 20 + 5 * i}, {level, 0, 1})});
  }
  for (const int columns : {0, 1, 2, 5, 99}) {
    const Picture sheet = contact_sheet("A title", panels, columns);
    for (const Panel& panel : panels) {
      const Colour colour = colour_at(panel.picture, 0, 0);
      int found = 0;
      for (int y = 0; y < sheet.height(); ++y) {
        for (int x = 0; x < sheet.width(); ++x) found += colour_at(sheet, x, y) == colour;
      }
      EXPECT_EQ(found, panel.picture.size().pixels()) << columns << " columns";
    }
    EXPECT_EQ(colour_at(sheet, 0, 0), kBackground);
  }
}

TEST(ContactSheet, OfNothingIsATitle) {
  const Picture sheet = contact_sheet("Nothing yet", {});
  int ink = 0;
  for (int y = 0; y < sheet.height(); ++y) {
    for (int x = 0; x < sheet.width(); ++x) ink += colour_at(sheet, x, y) == kInk;
  }
  EXPECT_GT(ink, 100);
}

}  // namespace
}  // namespace weft::report
