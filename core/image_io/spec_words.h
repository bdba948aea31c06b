// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

#include "core/image_io/image_io.h"

namespace weft {

/// The size of pixels in the words of a format ("openexr", "tiff", "png"); nothing where it is not known.
void add_density(OIIO::ImageSpec& spec, const std::string& format, PixelPitch pitch_mm);

/// What its colours are.
void add_color(OIIO::ImageSpec& spec, const std::string& format, ColorSpace color);

}  // namespace weft
