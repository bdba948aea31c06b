// SPDX-License-Identifier: Apache-2.0
#include "report/hemisphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/text.h"
#include "core/base/vec.h"
#include "report/preview.h"

namespace weft::report {
namespace {

constexpr double kMiddle_x = 260, kMiddle_y = 285, kEdge = 235;
constexpr double kMostShown_deg = 90;
constexpr std::array<int, 3> kRings_deg = {30, 60, 90};
constexpr const char* kQuiet = "#77736b";

struct OnPaper {
  double x, y;
};
OnPaper on_paper(const SkyPoint& point) {
  const double r = kEdge * std::min(point.from_axis_deg, kMostShown_deg) / kMostShown_deg;
  const double azimuth = radians(point.azimuth_deg);
  return {kMiddle_x + r * std::cos(azimuth), kMiddle_y - r * std::sin(azimuth)};
}

double ring(int angle_deg) {
  return kEdge * angle_deg / kMostShown_deg;
}

std::string rings() {
  std::string drawing;
  for (const int angle : kRings_deg) {
    drawing += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{:.1f}\" fill=\"none\" stroke=\"#dcd8cf\"/>",
                           kMiddle_x, kMiddle_y, ring(angle));
  }
  return drawing;
}

// Over the dots, with a white rim.
std::string ring_names() {
  std::string drawing;
  for (const int angle : kRings_deg) {
    drawing += fmt::format(
        "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"middle\" fill=\"{}\" stroke=\"#ffffff\" "
        "stroke-width=\"3\" "
        "paint-order=\"stroke\">{}°</text>",
        kMiddle_x, kMiddle_y - ring(angle) + 4, kQuiet, angle);
  }
  return drawing;
}

std::string scale(double least, double most, const std::string& unit) {
  std::string drawing;
  for (int i = 0; i < 40; ++i) {
    drawing += fmt::format("<rect x=\"{:.1f}\" y=\"545\" width=\"10.3\" height=\"10\" fill=\"{}\"/>",
                           60 + 10.0 * i, css_colour(heat_colour((i + 0.5) / 40)));
  }
  return drawing + fmt::format(
                       "<text x=\"60\" y=\"572\" fill=\"{0}\">{1:.3g}</text><text x=\"460\" y=\"572\" "
                       "text-anchor=\"end\" fill=\"{0}\">{2:.3g} {3}</text>",
                       kQuiet, least, most, escape_markup(unit));
}

}  // namespace

std::string hemisphere_svg(const Hemisphere& drawing) {
  std::vector<SkyPoint> shown = drawing.values;
  std::erase_if(shown, [](const SkyPoint& point) { return !std::isfinite(point.value); });
  std::string body = rings();
  if (!shown.empty()) {
    const auto [low, high] = std::ranges::minmax(shown, {}, &SkyPoint::value);
    const double least = low.value, span = std::max(high.value - low.value, 1e-12);
    for (const SkyPoint& point : shown) {
      const auto [x, y] = on_paper(point);
      body += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"7\" fill=\"{}\"/>", x, y,
                          css_colour(heat_colour((point.value - least) / span)));
    }
    body += scale(least, high.value, drawing.unit);
  }
  body += ring_names();
  for (std::size_t k = 0; k < drawing.leds.size(); ++k) {
    const auto [x, y] = on_paper(drawing.leds[k]);
    body += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"11\" fill=\"#ffffff\" stroke=\"#1b1b1f\"/><text "
        "x=\"{0:.1f}\" y=\"{2:.1f}\" text-anchor=\"middle\">{3}</text>",
        x, y, y + 4, k + 1);
  }
  body += fmt::format("<path d=\"M{0} {1}h12M{2} {3}v12\" stroke=\"#1b1b1f\"/>", kMiddle_x - 6, kMiddle_y,
                      kMiddle_x, kMiddle_y - 6);
  if (drawing.best) {
    const auto [x, y] = on_paper(*drawing.best);
    body += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"13\" fill=\"none\" stroke=\"#b3261e\" "
        "stroke-width=\"3\"/><text x=\"{0:.1f}\" y=\"{2:.1f}\" text-anchor=\"middle\" "
        "fill=\"#b3261e\">{3:.3f}</text>",
        x, y, y + 28, drawing.best->value);
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 520 600\" role=\"img\" "
      "font-family=\"sans-serif\" "
      "font-size=\"12\"><rect width=\"520\" height=\"600\" fill=\"#ffffff\"/><text x=\"260\" y=\"24\" "
      "text-anchor=\"middle\" font-size=\"15\">{}</text>{}</svg>\n",
      escape_markup(drawing.title), body);
}

}  // namespace weft::report
