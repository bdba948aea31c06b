// SPDX-License-Identifier: Apache-2.0
#include "report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/statistics.h"
#include "core/text.h"
#include "report/html.h"
#include "report/preview.h"

namespace weft::report {
namespace {

constexpr const char* kFaint = "#77736b";

// Just over the 98th percentile of the finite values.
double upper_end(std::vector<double> values) {
  const double high = lower_quantile(finite(std::move(values)), 0.98);
  return std::isnan(high) ? 1 : std::max(1.1 * high, 1e-9);
}

}  // namespace

std::string frame_map_svg(const FrameMap& map) {
  const double least = map.least.value_or(0), most = map.most.value_or(upper_end(map.values));
  std::string drawing;
  for (int y = 0; y < map.rows; ++y) {
    for (int x = 0; x < map.columns; ++x) {
      const double v = map.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.columns) +
                                  static_cast<std::size_t>(x)];
      const std::string fill =
          std::isfinite(v) ? css_colour(heat_colour((v - least) / (most - least))) : "#ffffff";
      drawing += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"10.3\" height=\"10.3\" fill=\"{}\"/>", 10 * x,
                             10 * y, fill);
    }
  }
  const double width = 10.0 * map.columns, top = 10.0 * map.rows + 6;
  for (int i = 0; i < 40; ++i) {
    drawing += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"8\" fill=\"{}\"/>",
                           width * i / 40, top, width / 40 + 0.3, css_colour(heat_colour((i + 0.5) / 40)));
  }
  drawing += fmt::format(
      "<text x=\"0\" y=\"{0:.1f}\" fill=\"{1}\">{2:.3g}</text><text x=\"{3:.1f}\" y=\"{0:.1f}\" "
      "text-anchor=\"end\" fill=\"{1}\">{4:.3g} {5}</text>",
      top + 20, kFaint, least, width, most, escape_markup(map.unit));
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\">{}</svg>\n", width,
      top + 24, drawing);
}

std::string arrows_svg(Size frame, std::span<const Arrow> arrows, double magnification) {
  const double scale = 640.0 / frame.width, height = frame.height * scale;
  std::string drawing =
      fmt::format("<rect width=\"640\" height=\"{:.1f}\" fill=\"none\" stroke=\"#dcd8cf\"/>", height);
  for (const Arrow& a : arrows) {
    const double x = a.x_px * scale, y = a.y_px * scale;
    drawing += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"1.4\"/><line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" "
        "y2=\"{3:.1f}\" stroke=\"#b3261e\"/>",
        x, y, x + a.dx_px * scale * magnification, y + a.dy_px * scale * magnification);
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 {0:.0f}\" role=\"img\">{1}<text x=\"4\" "
      "y=\"{2:.1f}\" fill=\"{3}\">arrows {4:.4g} times as long as they are</text></svg>\n",
      height + 20, drawing, height + 15, kFaint, magnification);
}

}  // namespace weft::report
