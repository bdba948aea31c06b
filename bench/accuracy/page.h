// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "bench/accuracy/accuracy.h"
#include "bench/base/report.h"
#include "core/result.h"
#include "report/plot_svg.h"

namespace weft::bench {

/// All that docs/accuracy.md shows, as the benchmarks of the same names give it.
struct AccuracyFigures {
  Rows table, coverage, leds, curves, gates, bound, specular;
};
Result<AccuracyFigures> measure_figures(const AccuracyTableOptions& options);

/// Mean error against time over all scenes: levels, other methods, and each level from three to ten LEDs.
report::Plot accuracy_plot(const AccuracyFigures& figures);
/// The same of the settings of accuracy_curves().
report::Plot curves_plot(const AccuracyFigures& figures);

/// The page's generated part: plot and tables in Markdown.
std::string accuracy_markdown(const AccuracyFigures& figures);

/// `page` with what stands between its two marks replaced. kBadData where the marks are not there.
inline constexpr const char* kFiguresBegin = "<!-- figures: made by weft bench accuracy --docs -->";
inline constexpr const char* kFiguresEnd = "<!-- end of figures -->";
Result<std::string> with_figures(const std::string& page, const std::string& figures);

/// Renews the figures of `folder`/accuracy.md and writes pictures/accuracy.svg, curves.svg and accuracy.json.
Result<void> write_accuracy_docs(const std::filesystem::path& folder, const AccuracyFigures& figures);

}  // namespace weft::bench
