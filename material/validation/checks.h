// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/vec.h"
#include "material/validation/validate.h"

// The checks of validate(), by what they look at.

namespace weft::material {

/// What the checks share: the maps, which pixels count, and the albedo averaged 3 x 3 over those.
struct Checked {
  const MapsToValidate& maps;
  const ValidationLimits& limits;
  Image<std::uint8_t> counts;  ///< 1 where a pixel has cloth and a solution
  Image<float> albedo;
  double pixels = 0;  ///< that count

  const Surface& surface() const { return *maps.surface; }
  Size size() const { return maps.surface->size(); }
};

/// Rec.709.
inline double luminance_of(double r, double g, double b) {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
double luminance_at(const Image<float>& albedo, int x, int y);

/// The unit normal of the slopes at a pixel.
Vec3 normal_at(const Surface& surface, int x, int y);

/// 255 where `is`(x, y) says so among the pixels that count, and how many those are.
struct Marked {
  Image<std::uint8_t> where;
  double count = 0;
};
template <typename Is>
Marked marked(const Checked& checked, const Is& is) {
  Marked found = {Image<std::uint8_t>(checked.size()), 0};
  for (int y = 0; y < checked.size().height; ++y) {
    for (int x = 0; x < checked.size().width; ++x) {
      if (checked.counts(x, y) == 0 || !is(x, y)) continue;
      found.where(x, y) = 255;
      found.count += 1;
    }
  }
  return found;
}

Finding passed(std::string name, std::string text, double number, double limit);
Finding failed(Severity severity, Verdict verdict, double number, double limit,
               Image<std::uint8_t> where = {});

/// Whether a solve at the highest level would be another than this.
bool has_better_level(const Checked& checked);

// albedo.cpp
Finding dark_albedo(const Checked& checked);
Finding bright_albedo(const Checked& checked);
Finding gamut(const Checked& checked);
Finding saturation(const Checked& checked);
Finding greys(const Checked& checked);
Finding light_by_openness(const Checked& checked);
Finding light_by_normals(const Checked& checked);

// lobe.cpp
Finding f0_range(const Checked& checked);
Finding energy(const Checked& checked);
Finding lobe_energy(const Checked& checked);

// shape.cpp
Finding seam(const Checked& checked);
Finding normal_length(const Checked& checked);
Finding height_off_slopes(const Checked& checked);
Finding texel_density(const Checked& checked);

}  // namespace weft::material
