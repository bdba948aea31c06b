// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/transfer.h"
#include "core/image_io/image_io.h"

namespace weft {

/// What becomes of the full-scale values of integer files, which stand for anything brighter too.
enum class Clipped {
  kMark,  ///< saturated: +infinity
  kKeep,  ///< taken at their word, as published baselines do
};

/// What becomes of NaN and infinity in float files.
enum class NotNumbers {
  kRefuse,  ///< an export went wrong
  kMark,    ///< they say of a reading why it cannot be used (core/rig/radiometry.h)
};

/// Whether a file is a developed photograph (TIFF, PNG, EXR, JPEG by its extension), not a raw frame.
bool is_linear_image(const std::filesystem::path& file);

/// Header of a photograph: its only picture, whose channels are those of light (light_channels()).
Result<ImageFileInfo> read_linear_image_info(const std::filesystem::path& file);

/// Reads a photograph as readings (core/rig/radiometry.h): planes R, G, B, 1.0 is full scale. Grey is
/// repeated. A JPEG is refused for kLinear: what a camera made of it cannot be undone.
Result<Image<float>> read_linear_image(const std::filesystem::path& file, Transfer transfer, Clipped clipped,
                                       NotNumbers not_numbers = NotNumbers::kRefuse);

/// What kAuto means for a file; kAuto where it says of a curve that is neither, which read_linear_image()
/// then refuses.
Transfer transfer_of(const ImageFileInfo& info);

/// Where R, G and B stand in a file; thrice the same of a grey one.
using LightChannels = std::array<std::size_t, 3>;
/// By their names: R, G, B of the picture or of its only layer that has them, Y, or a channel that is alone.
/// kBadData where that is not clear, or where they are no light: directions, luminance with chroma, counts
/// behind colour filters. `where` is the file's name for messages.
Result<LightChannels> light_channels(const ImageFileInfo& info, const std::string& where);

/// Which way stored rows are to be shown: the tag Orientation of TIFF 6.0 and EXIF, 1 to 8.
Size shown_size(Size stored, int orientation);
Image<float> as_shown(Image<float> stored, int orientation);
/// "as they are", "turned by half", as what is done to show them.
const char* orientation_words(int orientation);

/// image -= dark, sample by sample.
void subtract(Image<float>& image, const Image<float>& dark);
/// image += light.
void brighten(Image<float>& image, double light);
/// image *= factor.
void scale(Image<float>& image, double factor);

}  // namespace weft
