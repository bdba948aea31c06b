// SPDX-License-Identifier: Apache-2.0
#include "material/layers/masks.h"

#include <algorithm>
#include <utility>

#include "material/maps/cavity.h"

namespace weft::material {
namespace {

// Each value of a field of one plane by `change`.
template <typename Change>
void change_each(ParameterField& field, const Change& change) {
  if (!field.is_map()) {
    field.constant[0] = change(field.constant[0]);
    return;
  }
  for (int y = 0; y < field.map.height(); ++y) {
    float* row = field.map.plane().row(y);
    for (int x = 0; x < field.map.width(); ++x) row[x] = static_cast<float>(change(double{row[x]}));
  }
}

}  // namespace

Result<void> level(ParameterField& mask, const MaskLevels& levels) {
  const double span = levels.one - levels.zero;
  if (span == 0)
    return Error{ErrorKind::kUsage, "a mask cannot be levelled", "levels", "both values are alike",
                 "give two that differ"};
  change_each(mask, [&](double value) { return std::clamp((value - levels.zero) / span, 0.0, 1.0); });
  return {};
}

Result<ParameterField> cavity_mask(const ParameterField& height_mm, const CavityMaskOptions& options) {
  if (!height_mm.is_map()) return ParameterField::same(0.5);
  Result<Cavity> found = cavity(height_mm.map.plane(), {.mm_per_pixel = options.mm_per_pixel,
                                                        .radius_mm = options.radius_mm,
                                                        .range_mm = options.range_mm,
                                                        .is_tile = options.is_tile,
                                                        .threads = options.threads});
  if (!found) return std::move(found).error();
  return ParameterField::of(std::move(found->cavity));
}

ParameterField height_mask(const ParameterField& height_mm, double at_mm, double soft_mm) {
  ParameterField mask = copy_of(height_mm);
  change_each(mask, [&](double height) {
    if (!(soft_mm > 0)) return height > at_mm ? 1.0 : 0.0;
    const double t = std::clamp((height - at_mm) / soft_mm + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  });
  return mask;
}

}  // namespace weft::material
