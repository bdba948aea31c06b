// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace weft::report {

/// One page to print at its true size: rectangles, rings and lines of words. Lengths in mm, from the lower
/// left corner. The same calls make the same bytes.
class PdfPage {
 public:
  PdfPage(double width_mm, double height_mm) : width_mm_(width_mm), height_mm_(height_mm) {}

  double width_mm() const { return width_mm_; }
  double height_mm() const { return height_mm_; }

  void fill(double x_mm, double y_mm, double width_mm, double height_mm);  ///< black
  /// In red, green and blue as a display shows them, 0 to 1.
  void fill(double x_mm, double y_mm, double width_mm, double height_mm,
            const std::array<double, 3>& display_rgb);
  void ring(double x_mm, double y_mm, double radius_mm, double line_mm);  ///< about (x, y)
  /// In Helvetica, its letters so high; of ASCII, what is none is left out.
  void write(double x_mm, double y_mm, double letters_mm, std::string_view words);

  std::string bytes() const;

 private:
  double width_mm_, height_mm_;
  std::string drawing_;
};

}  // namespace weft::report
