// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <fmt/format.h>

#include <cctype>

#include "core/text.h"
#include "report/html.h"

namespace weft::report {
namespace {

std::string paragraph(std::string_view text, std::string_view attributes = "") {
  return fmt::format("<p{}>{}</p>\n", attributes, escape_markup(text));
}

std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.back() == '.' ? text : text + '.';
}

std::string row_of(const std::vector<std::string>& cells, const char* tag, bool is_alarm = false) {
  std::string html = is_alarm ? "<tr class=\"alarm\">" : "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    html += fmt::format("<{0}{1}>{2}</{0}>", tag, i == 0 ? "" : " class=\"n\"", escape_markup(cells[i]));
  }
  return html + "</tr>\n";
}

}  // namespace

std::string verdict_box(const std::vector<Verdict>& verdicts, std::string_view otherwise) {
  std::string body;
  for (const Verdict& verdict : verdicts) {
    body += paragraph(sentence(verdict.text));
    if (!verdict.remedy.empty()) body += paragraph(sentence(verdict.remedy), " class=\"do\"");
  }
  if (verdicts.empty()) body = paragraph(otherwise);
  return fmt::format("<div class=\"verdict{}\">\n{}</div>\n", verdicts.empty() ? "" : " alarm", body);
}

std::string html_of(const Table& table) {
  std::string html = "<table>\n";
  if (!table.header.empty()) html += row_of(table.header, "th");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    html += row_of(table.rows[i], "td", table.alarms.count(i) != 0);
  }
  return html + "</table>\n";
}

std::string html_of(const Section& section) {
  std::string body;
  for (const std::string& text : section.paragraphs) body += paragraph(text);
  if (section.table) body += html_of(*section.table);
  std::string figures;
  for (const Figure& figure : section.figures) {
    figures += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", figure.svg,
                           escape_markup(figure.label));
  }
  if (section.figures.size() > 1) figures = "<div class=\"two\">\n" + figures + "</div>\n";
  return html_section(section.title, body + figures);
}

std::string html_of(const Page& page) {
  const std::string summary = sentence(page.summary);
  std::string body = fmt::format("<h1>{}</h1>\n", escape_markup(page.title));
  if (!page.verdicts.empty()) body += paragraph(summary, " class=\"meta\"");
  body += verdict_box(page.verdicts, summary);
  for (const Section& section : page.sections) body += html_of(section);
  return html_page(page.title, body);
}

}  // namespace weft::report
