// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/calibrate/report.h"

#include <fmt/format.h>

#include "core/files.h"
#include "core/text.h"
#include "report/html.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

std::string paragraph(std::string_view text, std::string_view style = "") {
  return fmt::format("<p{}>{}</p>\n", style, escape_markup(text));
}

std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.back() == '.' ? text : text + '.';
}

std::string head(const CalibrationReport& report) {
  std::string body;
  for (const Verdict& verdict : report.verdicts) {
    body += paragraph(sentence(verdict.text));
    if (!verdict.remedy.empty()) body += paragraph(sentence(verdict.remedy), " class=\"do\"");
  }
  const bool good = body.empty();
  if (good) body = paragraph(sentence(report.summary));
  return fmt::format("<h1>{}</h1>\n{}<div class=\"verdict{}\">\n{}</div>\n", escape_markup(report.title),
                     good ? "" : paragraph(sentence(report.summary), " class=\"meta\""), good ? "" : " alarm",
                     body);
}

std::string cells(const std::vector<std::string>& row, const char* tag) {
  std::string html = "<tr>";
  for (std::size_t i = 0; i < row.size(); ++i) {
    html += fmt::format("<{0}{1}>{2}</{0}>", tag, i == 0 ? "" : " class=\"n\"", escape_markup(row[i]));
  }
  return html + "</tr>\n";
}

std::string section_of(const ReportSection& section) {
  std::string body;
  for (const std::string& text : section.paragraphs) body += paragraph(text);
  if (section.table) {
    body += "<table>\n" + cells(section.table->header, "th");
    for (const std::vector<std::string>& row : section.table->rows) body += cells(row, "td");
    body += "</table>\n";
  }
  std::string figures;
  for (const ReportPicture& picture : section.pictures) {
    figures += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", picture.svg,
                           escape_markup(picture.label));
  }
  const bool side_by_side = section.pictures.size() > 1;
  if (side_by_side) figures = "<div class=\"two\">\n" + figures + "</div>\n";
  return html_section(section.title, body + figures);
}

}  // namespace

Json document_of(const CalibrationReport& report) {
  return {{"schema", "weft.calibration-report/1"},
          {"part", report.part},
          {"title", report.title},
          {"summary", report.summary},
          {"verdicts", json_of(report.verdicts)},
          {"numbers", report.numbers}};
}

std::vector<NamedFile> report_files(const CalibrationReport& report) {
  std::string body = head(report);
  for (const ReportSection& section : report.sections) body += section_of(section);
  return {{report.part + ".html", html_page(report.title, body)},
          {report.part + ".json", document_of(report).dump(2) + "\n"}};
}

std::string rig_name(const std::string& named, const fs::path& input) {
  return named.empty() ? absolute_folder(input).parent_path().filename().string() : named;
}

Result<void> check_new(const fs::path& folder) {
  if (folder.empty() || !is_there(folder)) return {};
  return Error{ErrorKind::kCannotCreate, "there is something already", folder.string(),
               "what was measured is never overwritten", "name a new folder with -o"};
}

Result<void> write_report(const CalibrationReport& report, const fs::path& folder,
                          std::span<const NamedFile> more) {
  if (Result<void> ok = check_new(folder); !ok) return ok;
  PartialFolder partial(folder);
  if (Result<void> ok = make_writable_folder(partial.path()); !ok) return ok;
  std::vector<NamedFile> files = report_files(report);
  files.insert(files.end(), more.begin(), more.end());
  for (const NamedFile& file : files) {
    if (Result<void> ok = write_file(partial.path() / file.name, file.bytes); !ok) return ok;
  }
  return partial.publish();
}

}  // namespace weft::app
