// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "core/base/statistics.h"
#include "core/base/text.h"

namespace weft::report {
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

std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.back() == '.' ? text : text + '.';
}

// Just over the 98th percentile of the finite values.
double upper_end(std::vector<double> values) {
  const double high = lower_quantile(finite(std::move(values)), 0.98);
  return std::isnan(high) ? 1 : std::max(1.1 * high, 1e-9);
}

Json data_of(const Table& table) {
  return {{"header", table.header}, {"rows", table.rows}, {"alarms", table.alarms}, {"bars", table.bars}};
}

Json data_of(const Svg& drawing) {
  return {{"svg", drawing}};
}

Json data_of(const Png& picture) {
  return {{"png", base64(picture.bytes)}};
}

Json data_of(const FrameMap& map) {
  return {{"map",
           {{"columns", map.columns},
            {"values", map.values},
            {"unit", map.unit},
            {"least", map.least.value_or(0)},
            {"most", map.most.value_or(upper_end(map.values))}}}};
}

Json data_of(const Arrows& drawing) {
  Json all = Json::array();
  for (const Arrow& a : drawing.arrows) all.push_back({a.x_px, a.y_px, a.dx_px, a.dy_px});
  return {{"arrows",
           {{"width", drawing.frame.width},
            {"height", drawing.frame.height},
            {"all", std::move(all)},
            {"magnification", drawing.magnification}}}};
}

Json data_of(const Section& section) {
  Json figures = Json::array();
  for (const Figure& figure : section.figures) {
    figures.push_back(std::visit([](const auto& drawing) { return data_of(drawing); }, figure.drawing));
    figures.back()["label"] = figure.label;
  }
  Json data = {{"title", section.title},
               {"paragraphs", section.paragraphs},
               {"figures", std::move(figures)},
               {"note", section.note},
               {"is_half", section.is_half}};
  if (section.table) data["table"] = data_of(*section.table);
  return data;
}

bool says_something(const Section& section) {
  return !section.paragraphs.empty() || !section.figures.empty() ||
         (section.table && !section.table->rows.empty());
}

// JSON that may stand inside a script.
std::string within_script(const Json& data) {
  std::string text;
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    c == '<' ? text += "\\u003c" : text += c;
  }
  return text;
}

// What says most, until a script draws all of it.
std::string words_of(const Page& page) {
  std::string html = fmt::format("<h1>{}</h1>\n", escape_markup(page.title));
  for (const std::string& line : page.meta) html += fmt::format("<p>{}</p>\n", escape_markup(line));
  html += fmt::format("<p>{}</p>\n", escape_markup(page.summary));
  for (const Verdict& v : page.verdicts)
    html += fmt::format("<p>{} {}</p>\n", escape_markup(v.text), escape_markup(v.remedy));
  return html + "<p>Scripts draw the tables and figures of this page.</p>\n";
}

std::string words_of(const Json& value) {
  if (value.is_number_float()) return fmt::format("{:.4g}", value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string words;
  for (const Json& each : value) words += (words.empty() ? "" : ", ") + words_of(each);
  return words;
}

}  // namespace

void add_rows(Table& table, const Json& object, const std::vector<std::string>& lead,
              const std::string& within) {
  for (const auto& [key, value] : object.items()) {
    const std::string name = within.empty() ? key : within + " · " + key;
    if (value.is_object()) {
      add_rows(table, value, lead, name);
    } else {
      table.rows.push_back(lead);
      table.rows.back().insert(table.rows.back().end(), {name, words_of(value)});
    }
  }
}

std::string html_of(Page page) {
  page.summary = sentence(page.summary);
  for (Verdict& verdict : page.verdicts) {
    verdict.text = sentence(verdict.text);
    verdict.remedy = sentence(verdict.remedy);
  }
  Json data = {{"title", page.title},
               {"meta", page.meta},
               {"summary", page.summary},
               {"verdicts", json_of(page.verdicts)},
               {"sections", Json::array()}};
  for (const Section& section : page.sections) {
    if (says_something(section)) data["sections"].push_back(data_of(section));
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{}</title></head>\n<body><main>\n"
      "{}</main>\n<script type=\"application/json\" id=\"report\">{}</script>\n"
      "<script>{}</script></body></html>\n",
      escape_markup(page.title), words_of(page), within_script(data), script());
}

}  // namespace weft::report
