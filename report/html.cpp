// SPDX-License-Identifier: Apache-2.0
#include "report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace weft::report {
namespace {

constexpr std::string_view kStyle = R"(
:root { --ink: #22211f; --faint: #77736b; --line: #dcd8cf; --paper: #fdfcf9; --bar: #8f8a7e; --alarm: #b3261e; --good: #2f6b4f; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 14px/1.45 "Source Sans 3", "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
main { max-width: 1020px; margin: 0 auto; padding: 28px 32px 40px; }
h1 { font: 600 25px/1.2 Georgia, "Source Serif 4", serif; margin: 0; }
h2 { font-size: 12px; font-weight: 600; letter-spacing: .06em; text-transform: uppercase; color: var(--faint); margin: 0 0 8px; }
.meta { color: var(--faint); margin: 4px 0 0; }
.verdict { margin: 18px 0 22px; padding: 14px 18px; border-left: 4px solid var(--good); background: #f3f1ea; }
.verdict.alarm { border-color: var(--alarm); }
.verdict p { margin: 0; font: 18px/1.4 Georgia, "Source Serif 4", serif; }
.verdict p.do { font: 14px/1.45 "Source Sans 3", "Segoe UI", "Helvetica Neue", Arial, sans-serif; color: #55524b; margin-top: 3px; }
.verdict p + p:not(.do) { margin-top: 12px; }
section { margin: 0 0 24px; break-inside: avoid; }
.two { display: grid; grid-template-columns: 1fr 1fr; gap: 0 36px; align-items: start; }
.pictures { display: grid; grid-template-columns: repeat(4, 1fr); gap: 12px; }
figure { margin: 0; }
figure img { width: 100%; display: block; border: 1px solid var(--line); }
figcaption, .note { color: var(--faint); font-size: 12px; margin: 4px 0 0; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 3px 10px 3px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
th { font-weight: 600; font-size: 12px; color: var(--faint); }
td.n, th.n { text-align: right; }
td:last-child, th:last-child { padding-right: 0; }
tr.alarm td { color: var(--alarm); font-weight: 600; }
svg { display: block; width: 100%; height: auto; font: 12px "Source Sans 3", "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
@media (max-width: 760px) { .two { grid-template-columns: 1fr; } .pictures { grid-template-columns: 1fr 1fr; } }
@media print { @page { size: A4; margin: 12mm; } main { padding: 0; max-width: none; } body { background: #fff; font-size: 11.5px; } section { margin-bottom: 14px; } .verdict { -webkit-print-color-adjust: exact; print-color-adjust: exact; } svg, img { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)";

}  // namespace

std::string html_page(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>{}</style></head>\n"
      "<body><main>\n{}</main></body></html>\n",
      escape_markup(title), kStyle, body);
}

std::string html_section(std::string_view title, std::string_view body, std::string_view id) {
  const std::string mark = id.empty() ? "" : fmt::format(" id=\"{}\"", id);
  return fmt::format("<section{}><h2>{}</h2>\n{}</section>\n", mark, escape_markup(title), body);
}

std::string css_colour(Colour c) {
  const auto byte = [](float v) { return static_cast<int>(std::lround(255 * std::clamp(v, 0.0F, 1.0F))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

}  // namespace weft::report
