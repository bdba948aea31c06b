// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/accuracy/accuracy.h"
#include "bench/base/study.h"
#include "core/base/result.h"
#include "report/plot_svg.h"

namespace weft::bench {

/// All that the two pages on accuracy show, as the benchmarks give it.
struct AccuracyFigures {
  std::map<std::string, std::string> measured_by;  ///< each part that is there: version, processor, threads
  std::string listing;                             ///< what `weft solve --explain` prints
  Rows table, coverage, leds, curves, gates, bound, specular, explain, chain;
};

/// "table", "leds", ... "listing": what can be measured by itself.
const std::vector<std::string>& figure_parts();

struct FiguresOptions {
  AccuracyTableOptions table;
  std::vector<std::string> parts;  ///< of figure_parts(); empty: all
  std::filesystem::path program;   ///< weft itself, for the listing
};
/// Measures these parts anew. kUsage for a part that there is not.
Result<void> measure_figures(const FiguresOptions& options, AccuracyFigures& figures);

/// As docs/pictures/accuracy.json keeps them.
Json json_of(const AccuracyFigures& figures);
Result<AccuracyFigures> figures_from_json(const Json& document, const std::string& where);

/// Mean error against seconds of a 16-megapixel scan: the levels, on matt cloth, satin and velvet.
report::Plot levels_plot(const AccuracyFigures& figures);
/// Mean error against time over all scenes: levels, other methods, and each level from three to ten LEDs.
report::Plot accuracy_plot(const AccuracyFigures& figures);
/// The same of the settings of accuracy_curves().
report::Plot curves_plot(const AccuracyFigures& figures);

/// The pages, below the folder of documentation: the manual, with a summary, and the one with every table.
inline constexpr const char* kSummaryPage = "accuracy.md";
inline constexpr const char* kFiguresPage = "measured/accuracy.md";

/// Their generated parts in Markdown.
std::string summary_markdown(const AccuracyFigures& figures);
std::string accuracy_markdown(const AccuracyFigures& figures);

/// `page` with what stands between its marks replaced. kBadData where marks are not there.
inline constexpr const char* kSummaryBegin = "<!-- summary: made by weft bench accuracy --docs -->";
inline constexpr const char* kSummaryEnd = "<!-- end of summary -->";
inline constexpr const char* kFiguresBegin = "<!-- figures: made by weft bench accuracy --docs -->";
inline constexpr const char* kFiguresEnd = "<!-- end of figures -->";
Result<std::string> with_summary(const std::string& page, const AccuracyFigures& figures);
Result<std::string> with_figures(const std::string& page, const AccuracyFigures& figures);

/// Renews the generated parts of both pages in `folder` and writes pictures/levels.svg, accuracy.svg,
/// curves.svg and accuracy.json. Nothing is written where a page or its marks are not there.
Result<void> write_accuracy_docs(const std::filesystem::path& folder, const AccuracyFigures& figures);

/// The figures of `folder`/pictures/accuracy.json; none where there is no such file.
Result<AccuracyFigures> read_accuracy_docs(const std::filesystem::path& folder);

}  // namespace weft::bench
