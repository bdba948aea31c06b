// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/verdict.h"

// A page as data, and what it becomes (report/html.h). All text is plain; it is escaped on its way into the
// page.

namespace weft::report {

/// Rows of text under one header.
struct Table {
  std::vector<std::string> header = {};             ///< a title over each column; empty: none
  std::vector<std::vector<std::string>> rows = {};  ///< the first cell names the row, the others are numbers
  std::set<std::size_t> alarms = {};                ///< rows, from 0, that a verdict is about: drawn in red
};

/// A drawing and its label.
struct Figure {
  std::string label;  ///< written under it
  std::string svg;    ///< report/figures.h, report/plot_svg.h
};

/// A part of a page under a heading.
struct Section {
  std::string title;
  std::vector<std::string> paragraphs = {};
  std::optional<Table> table = {};
  std::vector<Figure> figures = {};  ///< two or more stand side by side
  bool is_answer = false;            ///< its table is what was asked for: on the terminal, too
};

/// What a report says, before it is HTML.
struct Page {
  std::string title;              ///< "Camera of rig A, 2026-01-31"
  std::string summary;            ///< one sentence with the numbers that matter most
  std::vector<Verdict> verdicts;  ///< what is wrong or weak, the gravest first; empty: all is well
  std::vector<Section> sections;
};

/// A whole page that needs no other file: title, verdicts (where there are none, the summary in their place)
/// and sections.
std::string html_of(const Page& page);

std::string html_of(const Section& section);
std::string html_of(const Table& table);

/// The coloured box on top of a page: every verdict with its remedy, or `otherwise` where there is none.
std::string verdict_box(const std::vector<Verdict>& verdicts, std::string_view otherwise);

}  // namespace weft::report
