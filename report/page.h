// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/json_document.h"
#include "core/image/image.h"
#include "core/solve/verdict.h"

// A report as data. The components of the page (app/web/src/report) draw it.

namespace weft::report {

/// Rows of text under one header.
struct Table {
  std::vector<std::string> header = {};  ///< a title over each column; empty: none
  /// The first cell names the row, in small letters after a line end; the others are numbers.
  std::vector<std::vector<std::string>> rows = {};
  std::set<std::size_t> alarms = {};  ///< rows, from 0, that a verdict is about: drawn in red
  std::vector<double> bars = {};      ///< of each row, before its last cell, 0 to 1; empty: none
};

/// Adds a row for each value of a JSON object of any shape, those of objects within it too: `lead`, its name
/// after those that it is within, the value.
void add_rows(Table& table, const Json& object, const std::vector<std::string>& lead = {},
              const std::string& within = "");

/// A drawing that is made: report/plot_svg.h.
using Svg = std::string;

/// A picture as the bytes of its file.
struct Png {
  std::string bytes;
};

/// Values over the frame as coloured squares, row by row from the upper left, those that are not finite
/// white, with a scale from `least` to `most`: without them from 0 to just over the 98th percentile.
struct FrameMap {
  int columns = 0, rows = 0;
  std::vector<double> values;  ///< columns x rows
  std::string unit;            ///< written after the upper end of the scale
  std::optional<double> least = {}, most = {};
};

/// A shift in the frame.
struct Arrow {
  double x_px = 0, y_px = 0;    ///< where it begins
  double dx_px = 0, dy_px = 0;  ///< from there to its tip
};
/// Arrows in a frame, drawn `magnification` times as long as they are.
struct Arrows {
  Size frame;
  std::vector<Arrow> arrows;
  double magnification = 1;
};

/// A drawing or a picture, and its label.
struct Figure {
  std::string label;  ///< written under it; may be empty
  std::variant<Svg, Png, FrameMap, Arrows> drawing;
};

/// A part of a page under a heading.
struct Section {
  std::string title = {};
  std::vector<std::string> paragraphs = {};
  std::optional<Table> table = {};
  std::vector<Figure> figures = {};  ///< two or more stand side by side
  bool is_answer = false;            ///< its table is what was asked for: on the terminal, too
  std::string note = {};             ///< in small letters at the end: how to read it
  bool is_half = false;              ///< half as wide: two such stand side by side
};

/// What a report says, before it is HTML.
struct Page {
  std::string title;                   ///< "Camera of rig A, 2026-01-31"
  std::vector<std::string> meta = {};  ///< lines under it: what was done with what
  std::string summary = {};            ///< one sentence with the numbers that matter most
  std::vector<Verdict> verdicts = {};  ///< what is wrong or weak, the gravest first; empty: all is well
  std::vector<Section> sections = {};  ///< those with neither text, rows nor figures are not shown
};

/// A whole page that needs no other file, for a screen and for paper: the data, and the script that draws it.
/// Without scripts it has the title, verdicts and summary. The same report gives the same bytes.
std::string html_of(Page page);

/// What draws it: app/web/dist/report.js, with its style.
std::string_view script();

}  // namespace weft::report
