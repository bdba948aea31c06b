// SPDX-License-Identifier: Apache-2.0
#include "report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/text.h"
#include "report/html.h"
#include "report/preview.h"

namespace weft::app {
namespace {

constexpr const char* kFaint = "#77736b";

double upper_end(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return 1;
  std::sort(values.begin(), values.end());
  return std::max(1.1 * values[(values.size() - 1) * 98 / 100], 1e-9);
}

// One axis of a plot: values to a stretch of the drawing.
struct Axis {
  double from = 0, to = 1;  ///< of the drawing
  bool log = false;
  double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();

  bool takes(double v) const { return std::isfinite(v) && (!log || v > 0); }
  double scaled(double v) const { return log ? std::log10(v) : v; }
  void include(double v) {
    least = std::min(least, scaled(v));
    most = std::max(most, scaled(v));
  }
  void close() {
    if (!(least <= most)) least = 0, most = 1;
    const double margin = most > least ? 0.05 * (most - least) : 0.5 * std::max(std::abs(most), 1e-3);
    least -= margin;
    most += margin;
  }
  double at(double v) const { return from + (scaled(v) - least) / (most - least) * (to - from); }
  /// Round numbers: three to eight of them, or the powers of ten.
  std::vector<double> ticks() const {
    std::vector<double> values;
    if (log && most - least > 1.5) {
      for (double e = std::ceil(least); e <= most; ++e) values.push_back(std::pow(10, e));
      return values;
    }
    const double low = log ? std::pow(10, least) : least, high = log ? std::pow(10, most) : most;
    double step = std::pow(10, std::floor(std::log10((high - low) / 3)));
    for (const double factor : {2.0, 2.5, 2.0}) {
      if ((high - low) / step > 8) step *= factor;
    }
    const double first = std::ceil(low / step);
    for (int i = 0; (first + i) * step <= high; ++i) values.push_back((first + i) * step);
    return values;
  }
};

}  // namespace

std::string frame_map_svg(const FrameMap& map) {
  const double least = map.least.value_or(0), most = map.most.value_or(upper_end(map.values));
  std::string drawing;
  for (int y = 0; y < map.rows; ++y) {
    for (int x = 0; x < map.columns; ++x) {
      const double v = map.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.columns) +
                                  static_cast<std::size_t>(x)];
      const std::string fill =
          std::isfinite(v) ? css_colour(material::heat_colour((v - least) / (most - least))) : "#ffffff";
      drawing += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"10.3\" height=\"10.3\" fill=\"{}\"/>", 10 * x,
                             10 * y, fill);
    }
  }
  const double width = 10.0 * map.columns, top = 10.0 * map.rows + 6;
  for (int i = 0; i < 40; ++i) {
    drawing +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"8\" fill=\"{}\"/>",
                    width * i / 40, top, width / 40 + 0.3, css_colour(material::heat_colour((i + 0.5) / 40)));
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

std::string lines_svg(const LinePlot& plot) {
  constexpr std::array<const char*, 6> kDashes = {"none", "6 3", "2 3", "8 3 2 3", "1 2", "12 4"};
  constexpr double kLeft = 62, kRight = 620, kTop = 14, kBottom = 330;
  Axis horizontal = {kLeft, kRight, plot.log_x}, vertical = {kBottom, kTop, plot.log_y};
  const auto shown = [&](const Curve& c, std::size_t i) {
    return horizontal.takes(c.x[i]) && vertical.takes(c.y[i]);
  };
  for (const Curve& c : plot.curves) {
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      if (!shown(c, i)) continue;
      horizontal.include(c.x[i]);
      vertical.include(c.y[i]);
    }
  }
  horizontal.close();
  vertical.close();
  std::string drawing;
  for (const double v : horizontal.ticks()) {
    drawing += fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#e6e2d9\"/><text x=\"{0:.1f}\" "
        "y=\"{3}\" text-anchor=\"middle\" fill=\"{4}\">{5:.4g}</text>\n",
        horizontal.at(v), kTop, kBottom, kBottom + 16, kFaint, v);
  }
  for (const double v : vertical.ticks()) {
    drawing += fmt::format(
        "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#e6e2d9\"/><text x=\"{3}\" "
        "y=\"{4:.1f}\" text-anchor=\"end\" fill=\"{5}\">{6:.4g}</text>\n",
        kLeft, kRight, vertical.at(v), kLeft - 6, vertical.at(v) + 4, kFaint, v);
  }
  double legend_y = kTop + 14;
  for (std::size_t n = 0; n < plot.curves.size(); ++n) {
    const Curve& c = plot.curves[n];
    std::string line, marks;
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      if (!shown(c, i)) continue;
      const double x = horizontal.at(c.x[i]), y = vertical.at(c.y[i]);
      line += fmt::format("{:.1f},{:.1f} ", x, y);
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\"/>", x, y);
    }
    const char* dash = kDashes[n % kDashes.size()];
    if (c.joined) {
      drawing += fmt::format(
          "<polyline points=\"{}\" fill=\"none\" stroke=\"#22211f\" stroke-dasharray=\"{}\"/>", line, dash);
    }
    drawing += marks + fmt::format(
                           "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2}\" y2=\"{2}\" stroke=\"#22211f\" "
                           "stroke-dasharray=\"{3}\"/><text x=\"{4}\" y=\"{5}\">{6}</text>\n",
                           kRight + 12, kRight + 40, legend_y - 4, dash, kRight + 46, legend_y,
                           escape_markup(c.name));
    legend_y += 18;
  }
  drawing += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text><text transform=\"translate(13 {}) "
      "rotate(-90)\" text-anchor=\"middle\">{}</text>",
      (kLeft + kRight) / 2, kBottom + 34, escape_markup(plot.x_label), (kTop + kBottom) / 2,
      escape_markup(plot.y_label));
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 800 372\" role=\"img\" font-size=\"12\" "
      "font-family=\"sans-serif\">{}</svg>\n",
      drawing);
}

}  // namespace weft::app
