// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/numerics/numerics.h"

namespace weft::bench {
namespace {

// Millimetres of a page; text of 3 mm stays readable where the plot is printed at half size.
constexpr double kWidth = 180, kHeight = 110, kLeft = 22, kRight = 140, kTop = 8, kBottom = 92;
constexpr double kLeastError = 1e-13, kMostError = 180, kMostCondition = 1e8;

double x_of(double condition) {
  return kLeft + (kRight - kLeft) * std::log10(condition) / std::log10(kMostCondition);
}
double y_of(double error_deg) {
  const double share = std::log10(std::clamp(error_deg, kLeastError, kMostError) / kLeastError) /
                       std::log10(kMostError / kLeastError);
  return kBottom - (kBottom - kTop) * share;
}

struct Line {
  const char* key;
  const char* label;
  const char* colour;
  const char* dashes;  ///< what tells it apart without colour
  double width;
  double label_y;  ///< beside the right edge
};

constexpr std::array<Line, 6> kLines = {
    {{"float32_normal_equations_deg", "normal equations, float32", "#b2182b", "none", 0.5, 10},
     {"float32_svd_deg", "SVD, float32", "#d6604d", "2 1", 0.5, 16},
     {"float32_qr_deg", "QR, float32", "#e08214", "0.6 0.8", 0.5, 22},
     {"double_normal_equations_deg", "normal equations, double", "#2166ac", "none", 0.5, 34},
     {"double_svd_deg", "SVD, double", "#4393c3", "2 1", 0.5, 62},
     {"ours_deg", "weft solve --quality fast", "#000000", "none", 1.1, 46}}};

std::string text(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, words);
}

std::string axes() {
  std::string svg;
  for (int decade = 0; decade <= 8; ++decade) {
    const double x = x_of(std::pow(10, decade));
    svg += fmt::format("<path class=\"grid\" d=\"M{:.2f} {} V{}\"/>\n", x, kTop, kBottom);
    svg += text(x, kBottom + 4.5, "middle", decade == 0 ? "1" : fmt::format("1e{}", decade));
  }
  for (int decade = -12; decade <= 2; decade += 2) {
    const double y = y_of(std::pow(10, decade));
    svg += fmt::format("<path class=\"grid\" d=\"M{} {:.2f} H{}\"/>\n", kLeft, y, kRight);
    svg += text(kLeft - 1.5, y + 1, "end", decade == 0 ? "1" : fmt::format("1e{}", decade));
  }
  svg += text((kLeft + kRight) / 2, kBottom + 11, "middle", "condition number of the light directions");
  svg += fmt::format(
      "<text transform=\"translate(5 {:.1f}) rotate(-90)\" text-anchor=\"middle\">worst of 300 "
      "pixels, degrees</text>\n",
      (kTop + kBottom) / 2);
  return svg;
}

std::string curve_of(const Rows& rows, const Line& line) {
  std::string points;
  for (const Json& row : rows) {
    points += fmt::format("{:.2f},{:.2f} ", x_of(row["condition"]), y_of(row[line.key]));
  }
  const double end = y_of(rows.back()[line.key]);
  return fmt::format("<polyline points=\"{}\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"/>\n",
                     points, line.colour, line.width, line.dashes) +
         fmt::format("<path d=\"M{} {:.2f} L{} {:.2f}\" stroke=\"{}\" stroke-width=\"0.2\"/>\n", kRight + 0.5,
                     end, kRight + 3.5, line.label_y - 1, line.colour) +
         text(kRight + 4, line.label_y, "start", line.label);
}

// From where on pixels say that they are ill conditioned.
std::string flagged(const Rows& rows) {
  const auto first =
      std::find_if(rows.begin(), rows.end(), [](const Json& row) { return row["flagged"].get<bool>(); });
  if (first == rows.end()) return {};
  const double x = x_of((*first)["condition"]);
  return fmt::format("<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"{}\" fill=\"#e4e4e4\"/>\n", x,
                     kTop, kRight - x, kBottom - kTop) +
         text((x + kRight) / 2, kTop - 2, "middle", "flagged");
}

}  // namespace

std::string numerics_plot(const Rows& curve) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 "
      "{} {}\">\n",
      kWidth, kHeight, kWidth, kHeight);
  svg +=
      "<style>text{font:3px sans-serif;fill:#000}.grid{stroke:#bbb;stroke-width:.15}polyline{fill:none;"
      "stroke-linejoin:round}</style>\n";
  svg += fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n", kWidth, kHeight);
  svg += flagged(curve) + axes();
  for (const Line& line : kLines) svg += curve_of(curve, line);
  return svg + "</svg>\n";
}

}  // namespace weft::bench
