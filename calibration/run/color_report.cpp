// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/color_report.h"
#include "core/rig/color_transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft::calibration {
namespace {

std::string css(const Rgb& linear) {
  const Rgb display = srgb_of_rec709(linear);
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround(255 * display[0]), std::lround(255 * display[1]),
                     std::lround(255 * display[2]));
}

double most_of(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

report::Section patches_section(const ColorMeasurement& color) {
  return {.title = "Patches",
          .paragraphs = {fmt::format("Each patch as it should be ({}) on the left, and as it came out on the "
                                     "right; colours outside the screen's are clipped.",
                                     color.reference)},
          .figures = {{"reference | measured", patches_svg(color)}}};
}

report::Section differences_section(const ColorMeasurement& color) {
  const bool has_curve = !color.by_curve.empty();
  report::Table table = {{"patch", "before", "after", "held out"}, {}};
  if (has_curve) table.header.insert(table.header.end(), {"curve", "curve, held out"});
  const auto row_of = [&](const std::string& name, const auto& value) {
    std::vector<std::string> row = {name};
    for (const auto* list : {&color.fit.before, &color.fit.off, &color.fit.left_out}) {
      row.push_back(fmt::format("{:.2f}", value(*list)));
    }
    if (has_curve) {
      row.push_back(fmt::format("{:.2f}", value(color.by_curve)));
      row.push_back(fmt::format("{:.2f}", value(color.curve_left_out)));
    }
    table.rows.push_back(std::move(row));
  };
  row_of("mean", mean_of);
  row_of("largest", most_of);
  for (std::size_t i = 0; i < color.patches.size(); ++i) {
    row_of(fmt::format("{} {}", color.patches[i] + 1, patch_name(color.patches[i])),
           [&](const std::vector<double>& list) { return list[i]; });
  }
  return {
      .title = "Colour differences",
      .paragraphs =
          {"CIEDE2000 (Sharma, Wu, Dalal 2005) of every patch: the camera's own channels with the scale that "
           "suits them best; after the matrix; and held out, by the matrix fitted to all other patches."},
      .table = std::move(table)};
}

report::Section matrix_section(const ColorMeasurement& color) {
  report::Table table = {{"", "red", "green", "blue"}, {}};
  const char* const names[] = {"red", "green", "blue"};
  for (std::size_t r = 0; r < 3; ++r) {
    std::vector<std::string> row = {names[r]};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t entry = 3 * r + c;
      const double sigma = std::sqrt(std::max(color.fit.covariance[entry * 9 + entry], 0.0));
      row.push_back(fmt::format("{:.4f} ({:.4f})", color.fit.rec709_from_camera[r][c], sigma));
    }
    table.rows.push_back(std::move(row));
  }
  return {.title = "Matrix",
          .paragraphs = {"Linear Rec.709 from the camera's channels after white balance; rows sum to 1, so "
                         "that white stays white. Standard deviations in brackets."},
          .table = std::move(table)};
}

}  // namespace

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

std::string patches_svg(const ColorMeasurement& color) {
  constexpr int kSide = 60, kStep = 66;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#222\"/>\n",
      kChartColumns * kStep + 6, kChartRows * kStep + 6);
  for (std::size_t i = 0; i < color.patches.size(); ++i) {
    const int x = 6 + color.patches[i] % kChartColumns * kStep;
    const int y = 6 + color.patches[i] / kChartColumns * kStep;
    const Rgb measured = rec709_of_camera(color.transform, color.samples[i].camera);
    svg += fmt::format(
        "<rect x=\"{0}\" y=\"{2}\" width=\"{3}\" height=\"{4}\" fill=\"{5}\"/><rect x=\"{1}\" y=\"{2}\" "
        "width=\"{3}\" height=\"{4}\" fill=\"{6}\"/>\n",
        x, x + kSide / 2, y, kSide / 2, kSide, css(color.samples[i].reference), css(measured));
  }
  return svg + "</svg>\n";
}

CalibrationReport report_of(const ColorMeasurement& color, const std::string& rig) {
  CalibrationReport report;
  report.part = "color";
  report.title = fmt::format("Colour of rig {}", rig);
  report.summary = fmt::format(
      "CIEDE2000 of {} patches: mean {:.2f} before, {:.2f} after, {:.2f} held out (largest {:.2f})",
      color.patches.size(), mean_of(color.fit.before), mean_of(color.fit.off), mean_of(color.fit.left_out),
      most_of(color.fit.left_out));
  if (!color.by_curve.empty()) {
    report.summary += fmt::format("; by the curve in xyY {:.2f}, held out {:.2f}", mean_of(color.by_curve),
                                  mean_of(color.curve_left_out));
  }
  report.verdicts = color.verdicts;
  report.sections = {patches_section(color), differences_section(color), matrix_section(color)};
  report::Section sources = {"Sources"};
  sources.paragraphs = color.sources;
  if (color.has_albedo) {
    sources.paragraphs.push_back(fmt::format(
        "The chart's reflectances are {:.4f} times the albedo that was solved by the lights of before.",
        color.albedo_scale));
  } else {
    sources.paragraphs.push_back(fmt::format(
        "Light over the chart differed by {:.0f} percent, and was fitted.", 100 * color.slope_of_light));
  }
  report.sections.push_back(std::move(sources));

  Json names = Json::array();
  for (const int patch : color.patches) names.push_back(patch + 1);
  report.numbers = {{"patches", std::move(names)},
                    {"reference", color.reference},
                    {"sources", color.sources},
                    {"mean_before", mean_of(color.fit.before)},
                    {"mean_after", mean_of(color.fit.off)},
                    {"mean_held_out", mean_of(color.fit.left_out)},
                    {"largest_held_out", most_of(color.fit.left_out)},
                    {"before", color.fit.before},
                    {"after", color.fit.off},
                    {"held_out", color.fit.left_out},
                    {"rec709_from_camera", color.fit.rec709_from_camera},
                    {"slope_of_light", color.slope_of_light}};
  if (color.has_albedo) report.numbers["chart_over_albedo"] = color.albedo_scale;
  if (!color.by_curve.empty()) {
    report.numbers["mean_by_curve"] = mean_of(color.by_curve);
    report.numbers["mean_by_curve_held_out"] = mean_of(color.curve_left_out);
  }
  return report;
}

}  // namespace weft::calibration
