// SPDX-License-Identifier: Apache-2.0
#include "material/finish/crop.h"

#include <fmt/format.h>

#include <cmath>

#include "material/finish/part.h"
#include "material/usable.h"

namespace weft::material {

Result<Cropped> crop(const Surface& surface, const CropOptions& options) {
  if (auto usable = check_surface(surface, 1, "nothing can be cut out"); !usable)
    return std::move(usable).error();
  const Size size = surface.size();
  const double mm = surface.mm_per_pixel;
  const auto pixels = [&](double from_mm, double length_mm, int all, int& first, int& last) {
    const double begin = std::round(from_mm / mm),
                 end = length_mm == 0 ? all : std::round((from_mm + length_mm) / mm);
    if (!(begin >= 0 && end > begin && end <= all)) return false;
    first = static_cast<int>(begin);
    last = static_cast<int>(end);
    return true;
  };
  Rect part;
  if (!pixels(options.left_mm, options.width_mm, size.width, part.x0, part.x1) ||
      !pixels(options.top_mm, options.height_mm, size.height, part.y0, part.y1)) {
    return Error{
        ErrorKind::kUsage, "nothing can be cut out", "crop",
        fmt::format("{:.4g} x {:.4g} mm from ({:.4g}, {:.4g}) mm do not lie in a cloth of {:.4g} x {:.4g} mm",
                    options.width_mm, options.height_mm, options.left_mm, options.top_mm, size.width * mm,
                    size.height * mm),
        "give a part of the cloth"};
  }
  return Cropped{part_of(surface, part), part};
}

}  // namespace weft::material
