// SPDX-License-Identifier: Apache-2.0
#include "report/pdf_page.h"

#include <fmt/format.h>

#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

namespace weft::report {
namespace {

constexpr double kPoints = 72 / 25.4;  // a millimetre
constexpr double kCapitals = 0.718;    // height of Helvetica's capitals over its size

}  // namespace

void PdfPage::fill(double x_mm, double y_mm, double width_mm, double height_mm) {
  drawing_ += fmt::format("{:.4f} {:.4f} {:.4f} {:.4f} re f\n", kPoints * x_mm, kPoints * y_mm,
                          kPoints * width_mm, kPoints * height_mm);
}

void PdfPage::fill(double x_mm, double y_mm, double width_mm, double height_mm,
                   const std::array<double, 3>& rgb) {
  drawing_ += fmt::format("q {:.4f} {:.4f} {:.4f} rg {:.4f} {:.4f} {:.4f} {:.4f} re f Q\n", rgb[0], rgb[1],
                          rgb[2], kPoints * x_mm, kPoints * y_mm, kPoints * width_mm, kPoints * height_mm);
}

void PdfPage::ring(double x_mm, double y_mm, double radius_mm, double line_mm) {
  constexpr double kQuarter = 0.5522847498;  // Bezier arms of a quarter of a circle, over its radius
  const auto at = [&](double x, double y) {
    return fmt::format("{:.4f} {:.4f}", kPoints * (x_mm + radius_mm * x), kPoints * (y_mm + radius_mm * y));
  };
  drawing_ += fmt::format("{:.4f} w {} m\n", kPoints * line_mm, at(1, 0));
  double c = 1, s = 0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    drawing_ += fmt::format("{} {} {} c\n", at(c - kQuarter * s, s + kQuarter * c),
                            at(kQuarter * c - s, kQuarter * s + c), at(-s, c));
    std::tie(c, s) = std::pair(-s, c);
  }
  drawing_ += "S\n";
}

void PdfPage::write(double x_mm, double y_mm, double letters_mm, std::string_view words) {
  std::string safe;
  for (const char c : words) {
    if (c < ' ' || c > '~') continue;
    if (c == '(' || c == ')' || c == '\\') safe += '\\';
    safe += c;
  }
  drawing_ += fmt::format("BT /F1 {:.3f} Tf {:.4f} {:.4f} Td ({}) Tj ET\n", kPoints * letters_mm / kCapitals,
                          kPoints * x_mm, kPoints * y_mm, safe);
}

std::string PdfPage::bytes() const {
  const std::vector<std::string> objects = {
      "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents 4 0 R /Resources << "
                  "/Font << /F1 << /Type /Font /Subtype /Type1 /BaseFont /Helvetica >> >> >> >>",
                  kPoints * width_mm_, kPoints * height_mm_),
      fmt::format("<< /Length {} >>\nstream\n{}endstream", drawing_.size(), drawing_)};
  std::string pdf = "%PDF-1.4\n", places;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    places += fmt::format("{:010} 00000 n \n", pdf.size());
    pdf += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
  }
  const std::size_t table = pdf.size(), count = objects.size() + 1;
  return pdf + fmt::format(
                   "xref\n0 {0}\n0000000000 65535 f \n{1}trailer\n<< /Size {0} /Root 1 0 R >>\n"
                   "startxref\n{2}\n%%EOF\n",
                   count, places, table);
}

}  // namespace weft::report
