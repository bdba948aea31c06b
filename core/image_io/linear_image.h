// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"

namespace weft {

/// How the values of a developed photograph follow light.
enum class Transfer {
  kAuto,    ///< as the file says; where it does not, 16-bit and float files are linear, 8-bit ones sRGB
  kLinear,  ///< proportional to light
  kSrgb,    ///< IEC 61966-2-1
};
/// As the command line and documents have them.
inline constexpr std::array<const char*, 3> kTransferNames = {"auto", "linear", "srgb"};
constexpr const char* name_of(Transfer transfer) {
  return kTransferNames[static_cast<std::size_t>(transfer)];
}

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

/// Header of a photograph that can be solved: one, three or four channels.
Result<ImageFileInfo> read_linear_image_info(const std::filesystem::path& file);

/// Reads a photograph as readings (core/rig/radiometry.h): planes R, G, B, 1.0 is full scale. Grey is
/// repeated. A JPEG is refused for kLinear: what a camera made of it cannot be undone.
Result<Image<float>> read_linear_image(const std::filesystem::path& file, Transfer transfer, Clipped clipped,
                                       NotNumbers not_numbers = NotNumbers::kRefuse);

/// What kAuto means for a file; kAuto where it says of a curve that is neither, which read_linear_image()
/// then refuses.
Transfer transfer_of(const ImageFileInfo& info);

/// image -= dark, sample by sample.
void subtract(Image<float>& image, const Image<float>& dark);
/// image *= factor.
void scale(Image<float>& image, double factor);

}  // namespace weft
