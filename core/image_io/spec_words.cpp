// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/spec_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/image_io/color_profile.h"

namespace weft {
namespace {

// Rec.709 with D65: x and y of red, green, blue and white.
constexpr std::array<float, 8> kRec709 = {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};

}  // namespace

// OpenImageIO cuts a PNG's density to whole numbers, so it gets whole ones.
void add_density(OIIO::ImageSpec& spec, const std::string& format, PixelPitch pitch_mm) {
  const auto [x_mm, y_mm] = pitch_mm;
  if (!(x_mm > 0 && y_mm > 0)) return;
  const bool is_png = format == "png";
  const auto density = [&](double mm) {
    return static_cast<float>(is_png ? std::clamp(std::round(1000 / mm), 1.0, 16777216.0) : 25.4 / mm);
  };
  spec.attribute("ResolutionUnit", is_png ? "m" : "in");
  spec.attribute("XResolution", density(x_mm));
  if (format != "openexr") spec.attribute("YResolution", density(y_mm));
  // EXR and OpenImageIO's TIFF have the height by the aspect.
  if (!is_png && std::abs(x_mm / y_mm - 1) > 1e-9)
    spec.attribute("PixelAspectRatio", static_cast<float>(x_mm / y_mm));
}

// Of linear colour nothing is said to OpenImageIO: it would write a gamma of 1 into a PNG, which browsers
// brighten.
void add_color(OIIO::ImageSpec& spec, const std::string& format, ColorSpace color) {
  if (color == ColorSpace::kSrgb) spec.attribute("oiio:ColorSpace", "sRGB");
  if (color == ColorSpace::kSrgb && format == "tiff" && spec.nchannels >= 3) {
    const std::vector<std::uint8_t> profile = srgb_profile();
    spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())),
                   profile.data());
  }
  if (color == ColorSpace::kLinearColor && format == "openexr")
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kRec709.data());
}

}  // namespace weft
