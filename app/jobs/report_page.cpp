// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "app/jobs/left_out_report.h"
#include "app/jobs/reflectance.h"
#include "app/jobs/report.h"
#include "core/text.h"
#include "report/figures.h"
#include "report/html.h"
#include "report/page.h"

namespace weft::app {
namespace {

double number(const Json& object, const char* key, double otherwise = 0) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

std::string percent_text(double share) {
  const double p = 100 * share;
  if (p == 0) return "0 %";
  if (p < 0.01) return "< 0.01 %";
  return fmt::format(fmt::runtime(p < 1 ? "{:.2f} %" : "{:.1f} %"), p);
}

std::string light_noun(const Json& report) {
  return report.value("of", "session") == "session" ? "LED" : "Light";
}

// The lights that a fault names.
std::set<int> named(const Json& report) {
  std::set<int> numbers;
  for (const Json& fault : report["faults"]) {
    for (const Json& n : fault["lights"]) numbers.insert(n.get<int>());
  }
  return numbers;
}

std::string head(const Json& report) {
  const std::string title = report.value("title", "");
  return fmt::format(
      "<h1>{}</h1>\n<p class=\"meta\">solved by {} from {} lights · {} × {} pixels · {} albedo · {}</p>\n",
      escape_markup(title.empty() ? "Untitled cloth" : title), escape_markup(report.value("method", "")),
      report["lights"].size(), report.value("width", 0), report.value("height", 0),
      escape_markup(report.value("albedo_scale", "relative")), escape_markup(report.value("id", "")));
}

std::string verdict(const Json& report) {
  std::vector<Verdict> warnings;
  for (const Json& warning : report["warnings"]) {
    warnings.push_back({warning.value("name", ""), warning.value("text", ""), warning.value("remedy", "")});
  }
  std::string otherwise;
  if (report.value("looked_at", 0) == 0) {
    otherwise = "No pixel was bright and lit enough to hold the lights against each other.";
  } else if (report["lights"].size() < 6) {
    otherwise =
        "Nothing stands out. Six lights are needed to hold them against each other; here each was taken at "
        "its word.";
  } else {
    otherwise = fmt::format(
        "Nothing stands out: half of the pixels agree with the model to {} of the albedo or better, and no "
        "light contradicts its calibration.",
        percent_text(number(report, "residual_explained")));
  }
  return report::verdict_box(warnings, otherwise);
}

// A horizontal bar for each light: the median size of its residual.
std::string residual_chart(const Json& report) {
  const Json& lights = report["lights"];
  const std::set<int> alarm = named(report);
  double most = 1e-6;
  for (const Json& light : lights) most = std::max(most, number(light, "residual_median"));
  const int row = lights.size() > 24 ? 9 : 21, left = 62, width = 330;
  std::string bars;
  int y = 0;
  for (const Json& light : lights) {
    const double size = number(light, "residual_median");
    const int n = light.value("light", 0);
    const char* colour = alarm.count(n) != 0 ? "#b3261e" : "#8f8a7e";
    bars += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/>", left,
                        y + row / 7, std::max(1.0, size / most * width), row - 2 * (row / 7), colour);
    if (row > 12) {
      bars += fmt::format(
          "<text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"{}\">{} {}</text>"
          "<text x=\"{:.1f}\" y=\"{}\" fill=\"#77736b\">{}</text>\n",
          left - 8, y + 15, alarm.count(n) != 0 ? "#b3261e" : "#22211f", light_noun(report), n,
          left + size / most * width + 6, y + 15, escape_markup(percent_text(size)));
    } else if (n % 8 == 0 || alarm.count(n) != 0) {
      bars += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"{}\">{}</text>\n", left - 8,
                          y + 9, alarm.count(n) != 0 ? "#b3261e" : "#22211f", n);
    }
    y += row;
  }
  return fmt::format("<svg viewBox=\"0 0 460 {}\" role=\"img\">{}</svg>\n", y, bars) +
         "<p class=\"note\">Median deviation of the readings from a robust fit, over the albedo.</p>\n";
}

std::string status_chart(const Json& report) {
  std::string rows;
  for (const auto& [name, share] : report["status"].items()) {
    const double s = share.get<double>();
    rows += fmt::format(
        "<tr><td>{}</td><td style=\"width:45%\"><svg viewBox=\"0 0 200 12\" preserveAspectRatio=\"none\" "
        "style=\"height:12px;margin-top:4px\"><rect width=\"200\" height=\"12\" fill=\"#eeebe3\"/>"
        "<rect width=\"{:.1f}\" height=\"12\" fill=\"#8f8a7e\"/></svg></td><td class=\"n\">{}</td></tr>\n",
        escape_markup(name), 200 * std::clamp(s, 0.0, 1.0), escape_markup(percent_text(s)));
  }
  return "<table>\n" + rows +
         "</table>\n<p class=\"note\">Share of pixels with each bit of status.png; a pixel may have "
         "several.</p>\n";
}

// Predicted angle of the normal over the frame, in squares.
std::string sigma_map(const Json& report) {
  const Json& sigma = report["sigma_normal_deg"];
  if (!sigma["median"].is_number()) return "";
  report::FrameMap map = {sigma.value("columns", 0), sigma.value("rows", 0), {}, "°"};
  for (const Json& v : sigma["grid"]) map.values.push_back(v.is_number() ? v.get<double>() : NAN);
  const Json condition = report.value("condition", Json::object());
  std::string note = fmt::format(
      "Median {:.3g}°, 95 percent below {:.3g}°. Both hold for the {} of the cloth that has a normal.",
      number(sigma, "median"), number(sigma, "p95"), share_in_words(number(sigma, "solved", 1)));
  if (condition.contains("median") && condition["median"].is_number()) {
    note += fmt::format(" Condition number of all lights {:.2f}, at worst {:.2f}.",
                        number(condition, "median"), number(condition, "worst", INFINITY));
  }
  return report::html_section("How well the lights fix the normal",
                              report::frame_map_svg(map) + "<p class=\"note\">" + note + "</p>\n");
}

std::string budget(const Json& report) {
  std::string rows;
  for (const Json& b : report["budget"]) {
    const bool degrees = b.value("unit", "") == "deg";
    const double value = number(b, "value");
    rows += fmt::format("<tr><td>{}<br><span class=\"note\">{}</span></td><td class=\"n\">{}</td></tr>\n",
                        escape_markup(b.value("source", "")), escape_markup(b.value("what", "")),
                        degrees ? fmt::format("{:.3g}°", value) : escape_markup(percent_text(value / 100)));
  }
  if (const auto error = report.find("error"); error != report.end()) {
    rows += fmt::format(
        "<tr><td>all of it<br><span class=\"note\">mean error against the truth; 95 percent below {:.2f}°"
        "</span></td><td class=\"n\">{:.3g}°</td></tr>\n",
        number(*error, "p95_deg"), number(*error, "mean_deg"));
  }
  return "<table>\n" + rows + "</table>\n";
}

std::string light_table(const Json& report) {
  const std::set<int> alarm = named(report);
  report::Table table = {{"", "rms residual", "its mean", "gain", "in shadow", "saturated", "missing",
                          "outliers", "change over the frame"}};
  for (const Json& light : report["lights"]) {
    const int n = light.value("light", 0);
    const bool is_named = alarm.count(n) != 0;
    // Very many lights are not listed but for those that are named.
    if (report["lights"].size() > 24 && !is_named) continue;
    if (is_named) table.alarms.insert(table.rows.size());
    table.rows.push_back({fmt::format("{} {}", light_noun(report), n),
                          percent_text(number(light, "residual_rms")),
                          fmt::format("{:+.2f} %", 100 * number(light, "residual_mean")),
                          fmt::format("{:.1f} %", 100 * number(light, "gain", 1)),
                          percent_text(number(light, "shadowed")), percent_text(number(light, "saturated")),
                          percent_text(number(light, "missing")), percent_text(number(light, "outlier")),
                          fmt::format("{:.1f} % ({:.0f} %)", 100 * number(light, "gradient"),
                                      100 * number(light, "gradient_share"))});
  }
  if (table.rows.empty()) return "";
  return report::html_section(
      "Light by light",
      html_of(table) +
          fmt::format(
              "<p class=\"note\">From {} pixels all over the frame. Gain: what the light gives of what "
              "the other lights let expect, named faults put right. A residual that changes over the "
              "frame and explains much of its variance (in brackets) hints that a light has "
              "moved.</p>\n",
              report.value("looked_at", 0)));
}

// Names and plain values of a JSON object of any shape, as rows.
void flatten(const Json& value, const std::string& name, report::Table& table) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      flatten(inner, name.empty() ? key : name + " · " + key, table);
    }
    return;
  }
  table.rows.push_back({name, value.is_string()         ? value.get<std::string>()
                              : value.is_number_float() ? fmt::format("{:.4g}", value.get<double>())
                                                        : value.dump()});
}

std::string conditions(const Json& report) {
  report::Table table;
  for (const char* key : {"registration", "conditions"}) {
    if (const auto found = report.find(key); found != report.end()) flatten(*found, "", table);
  }
  return table.rows.empty() ? "" : report::html_section("Conditions", html_of(table));
}

std::string gates(const Json& report) {
  const auto found = report.find("gates");
  if (found == report.end() || !found->is_array()) return "";
  report::Table table = {{"stage", "measured", "limit", "verdict"}};
  for (const Json& gate : *found) {
    const std::string unit = gate.value("unit", "");
    table.rows.push_back({gate.value("name", ""), fmt::format("{:.3g} {}", number(gate, "value"), unit),
                          fmt::format("{:.3g} {}", number(gate, "limit"), unit), gate.value("verdict", "")});
  }
  return report::html_section("Gates", html_of(table));
}

std::string time(const Json& report) {
  report::Table table;
  for (const auto& [phase, seconds] : report["seconds"].items()) {
    table.rows.push_back({phase, fmt::format("{:.2f} s", seconds.get<double>())});
  }
  if (const auto foretold = report.find("foretold"); foretold != report.end()) {
    table.rows.push_back({"foretold of all of them", fmt::format("{:.2f} s", number(*foretold, "seconds"))});
    table.rows.push_back(
        {"and for it", error_in_words(number(*foretold, "mean_deg"), number(*foretold, "solved"))});
  }
  return table.rows.empty() ? "" : report::html_section("Time by phase", html_of(table), "time");
}

std::string two(const std::string& left, const std::string& right) {
  return "<div class=\"two\"><div>\n" + left + "</div><div>\n" + right + "</div></div>\n";
}

}  // namespace

std::string report_page(const Json& report, const std::vector<report::PagePicture>& pictures) {
  std::string page = head(report);
  page += verdict(report);
  page += report::picture_row(pictures);
  page += two(report::html_section("Residual by light", residual_chart(report)),
              report::html_section("Pixels by state", status_chart(report)));
  page += two(report::html_section("Where the error comes from", budget(report)), sigma_map(report));
  if (const auto found = report.find("reflectance"); found != report.end())
    page += reflectance_section(*found);
  page += light_table(report);
  page += left_out_section(report, light_noun(report));
  page += two(gates(report) + time(report), conditions(report));
  return report::html_page(report.value("title", "") + " · report of a solve", page);
}

}  // namespace weft::app
