// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "core/text.h"
#include "report/html.h"
#include "report/preview.h"

namespace weft::app {
namespace {

// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      out += i + j <= bytes.size() ? kDigits[group >> (18 - 6 * j) & 63U] : '=';
    }
  }
  return out;
}

double number(const Json& object, const char* key, double otherwise = 0) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

std::string percent(double share) {
  const double p = 100 * share;
  if (p == 0) return "0 %";
  if (p < 0.01) return "&lt; 0.01 %";
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
  std::string body;
  for (const Json& warning : report["warnings"]) {
    body += fmt::format("<p>{}.</p>\n", escape_markup(warning.value("text", "")));
    std::string remedy = warning.value("remedy", "");
    if (remedy.empty()) continue;
    remedy[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(remedy[0])));
    body += fmt::format("<p class=\"do\">{}.</p>\n", escape_markup(remedy));
  }
  if (!body.empty()) return "<div class=\"verdict alarm\">\n" + body + "</div>\n";
  if (report.value("looked_at", 0) == 0) {
    body = "<p>No pixel was bright and lit enough to hold the lights against each other.</p>\n";
  } else if (report["lights"].size() < 6) {
    body =
        "<p>Nothing stands out. Six lights are needed to hold them against each other; "
        "here each was taken at its word.</p>\n";
  } else {
    body = fmt::format(
        "<p>Nothing stands out: half of the pixels agree with the model to {} of the albedo or "
        "better, and no light contradicts its calibration.</p>\n",
        percent(number(report, "residual_explained")));
  }
  return "<div class=\"verdict\">\n" + body + "</div>\n";
}

std::string picture_row(const std::vector<PagePicture>& pictures) {
  if (pictures.empty()) return "";
  std::string body = "<div class=\"pictures\">\n";
  for (const PagePicture& p : pictures) {
    body += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        escape_markup(p.label), base64(p.png));
  }
  return "<section>" + body + "</div></section>\n";
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
          left + size / most * width + 6, y + 15, percent(size));
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
        escape_markup(name), 200 * std::clamp(s, 0.0, 1.0), percent(s));
  }
  return "<table>\n" + rows +
         "</table>\n<p class=\"note\">Share of pixels with each bit of status.png; a pixel may have "
         "several.</p>\n";
}

// Predicted angle of the normal over the frame, in squares, over a scale from 0.
std::string sigma_map(const Json& report) {
  const Json& sigma = report["sigma_normal_deg"];
  if (!sigma["median"].is_number()) return "";
  const int columns = sigma.value("columns", 0), rows = sigma.value("rows", 0);
  std::vector<double> known;
  for (const Json& v : sigma["grid"]) {
    if (v.is_number()) known.push_back(v.get<double>());
  }
  if (known.empty() || columns <= 0) return "";
  std::sort(known.begin(), known.end());
  const double full = std::max(known[known.size() * 98 / 100] * 1.1, 1e-6);
  std::string squares;
  for (int i = 0; i < columns * rows; ++i) {
    const Json& v = sigma["grid"][static_cast<std::size_t>(i)];
    squares +=
        fmt::format("<rect x=\"{}\" y=\"{}\" width=\"10.3\" height=\"10.3\" fill=\"{}\"/>",
                    10 * (i % columns), 10 * (i / columns),
                    v.is_number() ? css_colour(material::heat_colour(v.get<double>() / full)) : "#ffffff");
  }
  std::string scale;
  for (int i = 0; i < 40; ++i) {
    scale += fmt::format("<rect x=\"{}\" width=\"8.2\" height=\"10\" fill=\"{}\"/>", 8 * i,
                         css_colour(material::heat_colour((i + 0.5) / 40)));
  }
  const Json condition = report.value("condition", Json::object());
  std::string note =
      fmt::format("Median {:.3g}°, 95 percent below {:.3g}°.", number(sigma, "median"), number(sigma, "p95"));
  if (condition.contains("median") && condition["median"].is_number()) {
    note += fmt::format(" Condition number of all lights {:.2f}, at worst {:.2f}.",
                        number(condition, "median"), number(condition, "worst", INFINITY));
  }
  return html_section(
      "How well the lights fix the normal",
      fmt::format(
          "<svg viewBox=\"0 0 {} {}\" role=\"img\">{}</svg>\n"
          "<svg viewBox=\"0 0 320 22\" style=\"margin-top:6px;font-size:9px\">{}<text x=\"0\" y=\"20\" "
          "fill=\"#77736b\">0°</text><text x=\"320\" y=\"20\" text-anchor=\"end\" "
          "fill=\"#77736b\">{:.2g}°</text></svg>\n<p class=\"note\">{}</p>\n",
          10 * columns, 10 * rows, squares, scale, full, note));
}

std::string budget(const Json& report) {
  std::string rows;
  for (const Json& b : report["budget"]) {
    const bool degrees = b.value("unit", "") == "deg";
    const double value = number(b, "value");
    rows += fmt::format("<tr><td>{}<br><span class=\"note\">{}</span></td><td class=\"n\">{}</td></tr>\n",
                        escape_markup(b.value("source", "")), escape_markup(b.value("what", "")),
                        degrees ? fmt::format("{:.3g}°", value) : percent(value / 100));
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
  std::string rows;
  for (const Json& light : report["lights"]) {
    const int n = light.value("light", 0);
    // Of very many lights the first and those that are named.
    if (report["lights"].size() > 24 && alarm.count(n) == 0) continue;
    rows += fmt::format(
        "<tr{}><td>{} {}</td><td class=\"n\">{}</td><td class=\"n\">{:+.2f} %</td><td "
        "class=\"n\">{:.1f} %</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{:.1f} % ({:.0f} %)</td></tr>\n",
        alarm.count(n) != 0 ? " class=\"alarm\"" : "", light_noun(report), n,
        percent(number(light, "residual_rms")), 100 * number(light, "residual_mean"),
        100 * number(light, "gain", 1), percent(number(light, "shadowed")),
        percent(number(light, "saturated")), percent(number(light, "missing")),
        percent(number(light, "outlier")), 100 * number(light, "gradient"),
        100 * number(light, "gradient_share"));
  }
  if (rows.empty()) return "";
  return html_section(
      "Light by light",
      "<table><tr><th></th><th class=\"n\">rms residual</th><th class=\"n\">its mean</th><th "
      "class=\"n\">gain</th>"
      "<th class=\"n\">in shadow</th><th class=\"n\">saturated</th><th class=\"n\">missing</th><th "
      "class=\"n\">outliers</th><th class=\"n\">change over the frame</th></tr>\n" +
          rows +
          fmt::format(
              "</table>\n<p class=\"note\">From {} pixels all over the frame. Gain: what the light "
              "gives of what the other lights let expect, named faults put right. A residual that changes "
              "over the frame and explains much of its variance (in brackets) hints that a light has "
              "moved.</p>\n",
              report.value("looked_at", 0)));
}

// Names and plain values of a JSON object of any shape, as rows.
void flatten(const Json& value, const std::string& name, std::string& rows) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      flatten(inner, name.empty() ? key : name + " · " + key, rows);
    }
    return;
  }
  const std::string text = value.is_string()         ? value.get<std::string>()
                           : value.is_number_float() ? fmt::format("{:.4g}", value.get<double>())
                                                     : value.dump();
  rows +=
      fmt::format("<tr><td>{}</td><td class=\"n\">{}</td></tr>\n", escape_markup(name), escape_markup(text));
}

std::string conditions(const Json& report) {
  std::string rows;
  for (const char* key : {"registration", "conditions"}) {
    if (const auto found = report.find(key); found != report.end()) flatten(*found, "", rows);
  }
  return rows.empty() ? "" : html_section("Conditions", "<table>\n" + rows + "</table>\n");
}

std::string gates(const Json& report) {
  const auto found = report.find("gates");
  if (found == report.end() || !found->is_array()) return "";
  std::string rows;
  for (const Json& gate : *found) {
    const Json verdict_of = gate.value("verdict", Json());
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{:.3g} {}</td><td class=\"n\">{:.3g} {}</td><td>{}</td></tr>\n",
        escape_markup(gate.value("name", "")), number(gate, "value"), escape_markup(gate.value("unit", "")),
        number(gate, "limit"), escape_markup(gate.value("unit", "")),
        escape_markup(verdict_of.is_string() ? verdict_of.get<std::string>() : verdict_of.dump()));
  }
  return html_section("Gates",
                      "<table><tr><th>stage</th><th class=\"n\">measured</th><th class=\"n\">limit</th>"
                      "<th>verdict</th></tr>\n" +
                          rows + "</table>\n");
}

std::string time(const Json& report) {
  std::string rows;
  for (const auto& [phase, seconds] : report["seconds"].items()) {
    rows += fmt::format("<tr><td>{}</td><td class=\"n\">{:.2f} s</td></tr>\n", escape_markup(phase),
                        seconds.get<double>());
  }
  return rows.empty() ? "" : html_section("Time by phase", "<table>\n" + rows + "</table>\n", "time");
}

std::string two(const std::string& left, const std::string& right) {
  return "<div class=\"two\"><div>\n" + left + "</div><div>\n" + right + "</div></div>\n";
}

}  // namespace

std::string report_page(const Json& report, const std::vector<PagePicture>& pictures) {
  std::string page = head(report);
  page += verdict(report);
  page += picture_row(pictures);
  page += two(html_section("Residual by light", residual_chart(report)),
              html_section("Pixels by state", status_chart(report)));
  page += two(html_section("Where the error comes from", budget(report)), sigma_map(report));
  page += light_table(report);
  page += two(gates(report) + time(report), conditions(report));
  return html_page(report.value("title", "") + " · report of a solve", page);
}

}  // namespace weft::app
