// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/statistics.h"
#include "material/validation/checks.h"

namespace weft::material {
namespace {

enum class WrapAxis { kAcross, kDown };

// Rms step of a plane from line `i` to the next; of the last line, to the first.
double step_after(View<const float> plane, WrapAxis axis, int i) {
  const bool across = axis == WrapAxis::kAcross;
  const int lines = across ? plane.width() : plane.height(), along = across ? plane.height() : plane.width();
  const int next = (i + 1) % lines;
  double squares = 0;
  for (int j = 0; j < along; ++j) {
    const double step =
        across ? double{plane(next, j)} - double{plane(i, j)} : double{plane(j, next)} - double{plane(j, i)};
    squares += step * step;
  }
  return std::sqrt(squares / along);
}

/// The step at the wrap over the largest inside, of the plane where that is most.
double wrap_ratio(const Surface& surface, WrapAxis axis) {
  const int lines = axis == WrapAxis::kAcross ? surface.size().width : surface.size().height;
  double worst = 0;
  const auto look_at = [&](View<const float> plane) {
    double inside = 0;
    for (int i = 0; i + 1 < lines; ++i) inside = std::max(inside, step_after(plane, axis, i));
    const double wrap = step_after(plane, axis, lines - 1);
    if (wrap > 0) worst = std::max(worst, inside > 0 ? wrap / inside : 1e3);
  };
  for (int p = 0; p < surface.slope.planes(); ++p) look_at(surface.slope.plane(p));
  for (int p = 0; p < surface.albedo.planes(); ++p) look_at(surface.albedo.plane(p));
  return worst;
}

// How far off unit length, and 2 where that is no number or looks down.
double off_unit(const std::array<View<const float>, 3>& normals, int x, int y) {
  const Vec3 n = {double{normals[0](x, y)}, double{normals[1](x, y)}, double{normals[2](x, y)}};
  const double off = std::abs(length(n) - 1);
  return std::isfinite(off) && n.z > 0 ? off : 2;
}

/// Slopes of a height by central differences, where it has neighbours.
Vec3 normal_of_height(const Checked& checked, int x, int y) {
  const auto& height = checked.maps.height_mm;
  const double twice_mm = 2 * checked.surface().mm_per_pixel;
  const double p = (double{height(x + 1, y)} - double{height(x - 1, y)}) / twice_mm,
               q = (double{height(x, y - 1)} - double{height(x, y + 1)}) / twice_mm;
  return {-p, -q, 1};
}

}  // namespace

Finding seam(const Checked& checked) {
  const double across = wrap_ratio(checked.surface(), WrapAxis::kAcross),
               down = wrap_ratio(checked.surface(), WrapAxis::kDown), limit = checked.limits.seam;
  const double number = std::max(across, down);
  if (number <= limit) {
    return passed("SEAM", fmt::format("steps at the wrap are {:.2f} of the largest inside", number), number,
                  limit);
  }
  Image<std::uint8_t> where(checked.size());
  const int right = checked.size().width - 1, bottom = checked.size().height - 1;
  for (int y = 0; y <= bottom; ++y) {
    for (int x = 0; x <= right; ++x) {
      const bool at_side = across > limit && (x == 0 || x == right),
                 at_end = down > limit && (y == 0 || y == bottom);
      where(x, y) = at_side || at_end ? 255 : 0;
    }
  }
  return failed(
      Severity::kError,
      {"SEAM",
       fmt::format("the step where the tile goes on is {:.2f} of the largest inside from right to left and "
                   "{:.2f} from bottom to top",
                   across, down),
       "straighten the cloth before it is cut, or ask the step tile for other repeats"},
      number, limit, std::move(where));
}

Finding normal_length(const Checked& checked) {
  double worst = 0;
  Marked off = marked(checked, [&](int x, int y) {
    const double here = off_unit(checked.maps.normals, x, y);
    worst = std::max(worst, here);
    return here > checked.limits.normal_length;
  });
  const double limit = checked.limits.normal_length;
  if (off.count == 0) {
    return passed("NORMAL_LENGTH", fmt::format("normals are 1 long to {:.5f}", worst), worst, limit);
  }
  return failed(
      Severity::kError,
      {"NORMAL_LENGTH",
       fmt::format("{:.0f} normals are not 1 long to {:g}, look down or are no number", off.count, limit),
       "make the normals again from the slopes"},
      worst, limit, std::move(off.where));
}

Finding height_off_slopes(const Checked& checked) {
  std::vector<float> angles;
  double height_slopes = 0, slopes = 0;
  const auto angle_at = [&](int x, int y) {
    return angle_deg(normal_of_height(checked, x, y), normal_at(checked.surface(), x, y));
  };
  const auto inside = [&](int x, int y) {
    return x > 0 && y > 0 && x + 1 < checked.size().width && y + 1 < checked.size().height &&
           checked.counts(x, y) != 0;
  };
  for (int y = 0; y < checked.size().height; ++y) {
    for (int x = 0; x < checked.size().width; ++x) {
      if (!inside(x, y)) continue;
      const Vec3 of_height = normal_of_height(checked, x, y);
      const double p = double{checked.surface().slope(x, y, 0)}, q = double{checked.surface().slope(x, y, 1)};
      angles.push_back(static_cast<float>(angle_at(x, y)));
      height_slopes += -of_height.x * p - of_height.y * q;
      slopes += p * p + q * q;
    }
  }
  const double limit = checked.limits.height_off_slopes_deg;
  const double gain = slopes > 0 ? height_slopes / slopes : 1;
  const double number = angles.empty() ? 0 : double{median(std::move(angles))};
  if (number <= limit) {
    return passed("HEIGHT_OFF_SLOPES",
                  fmt::format("the height's slopes are {:.2f} degrees off the normals in the middle", number),
                  number, limit);
  }
  Marked off = marked(checked, [&](int x, int y) { return inside(x, y) && !(angle_at(x, y) <= limit); });
  // A height that was integrated comes as close to the slopes as any: it is they that close to no surface.
  const bool is_derived = checked.maps.is_height_of_slopes;
  return failed(
      is_derived ? Severity::kWarning : Severity::kError,
      {"HEIGHT_OFF_SLOPES",
       fmt::format("the height's slopes are {:.1f} degrees off the normals in the middle, and {:.3g} times "
                   "as steep{}",
                   number, gain, is_derived ? "; no height on these pixels has them" : ""),
       is_derived ? (has_better_level(checked)
                         ? "solve with --quality reference; leave it where normals alone are drawn"
                         : "leave it: normals show more of the relief than any height of these pixels can")
       : gain < 0 ? "turn the height or the green channel over"
                  : "check the unit and scale of the height"},
      number, limit, std::move(off.where));
}

Finding texel_density(const Checked& checked) {
  const double mm = checked.surface().mm_per_pixel;
  const ValidationLimits& limits = checked.limits;
  if (mm >= limits.least_mm_per_pixel && mm <= limits.most_mm_per_pixel) {
    return passed("TEXEL_DENSITY", fmt::format("{:.4g} mm a pixel, {:.0f} pixels a metre", mm, 1000 / mm), mm,
                  limits.most_mm_per_pixel);
  }
  const double limit = mm > limits.most_mm_per_pixel ? limits.most_mm_per_pixel : limits.least_mm_per_pixel;
  return failed(
      Severity::kWarning,
      {"TEXEL_DENSITY",
       fmt::format("{:.4g} mm a pixel is not between {:g} and {:g}", mm, limits.least_mm_per_pixel,
                   limits.most_mm_per_pixel),
       "ask for other pixels with --mm-per-pixel; where they are of another size, correct that in the "
       "step scale"},
      mm, limit);
}

}  // namespace weft::material
