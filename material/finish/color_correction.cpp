// SPDX-License-Identifier: Apache-2.0
#include "material/finish/color_correction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "material/usable.h"

namespace weft::material {

Result<Colored> color(Surface surface, const ColorOptions& options) {
  constexpr double kLeast = 0.01, kMost = 100;
  if (auto usable = check_surface(surface, 1, "colours stay as they are"); !usable)
    return std::move(usable).error();
  for (const double factor :
       {options.white_gains[0], options.white_gains[1], options.white_gains[2], options.exposure}) {
    if (!(factor >= kLeast && factor <= kMost)) {
      return Error{ErrorKind::kUsage, "colours stay as they are", "color",
                   fmt::format("{:.4g} is no factor", factor),
                   fmt::format("give factors of {} to {}", kLeast, kMost)};
    }
  }
  Colored out;
  std::int64_t above = 0;
  for (int y = 0; y < surface.albedo.height(); ++y) {
    for (int x = 0; x < surface.albedo.width(); ++x) {
      bool is_above = false;
      for (int p = 0; p < surface.albedo.planes(); ++p) {
        const double gain = options.exposure * options.white_gains[static_cast<std::size_t>(std::min(p, 2))];
        float& value = surface.albedo(x, y, p);
        value = static_cast<float>(gain * static_cast<double>(value));
        is_above = is_above || value > 1;
      }
      above += is_above;
    }
  }
  out.share_above_white = static_cast<double>(above) / static_cast<double>(surface.size().pixels());
  out.surface = std::move(surface);
  return out;
}

Result<Surface> scale(Surface surface, double mm_per_pixel) {
  if (!(mm_per_pixel > 0 && std::isfinite(mm_per_pixel))) {
    return Error{ErrorKind::kUsage, "the scale stays as it is", "scale", "mm_per_pixel is not above 0",
                 "give a size above 0"};
  }
  surface.mm_per_pixel = mm_per_pixel;
  return surface;
}

}  // namespace weft::material
