// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "exchange/document.h"

// What a file of texels is, by its first bytes.

namespace weft::exchange {

enum class ImageKind { kPng, kJpeg, kTiff, kExr };
const char* name_of(ImageKind kind);  ///< "PNG"

std::optional<ImageKind> kind_of_image(std::string_view bytes);
/// By the extension: ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr" in letters of either case.
std::optional<ImageKind> kind_of_file_name(std::string_view file);

/// The pixels that a PNG's header states; nothing for anything else.
std::optional<Size> png_size(std::string_view bytes);

/// The bytes of a texture of `material`. kBadData: they are missing, are not of one of the `kinds`, or are a
/// PNG whose size is not that of the texture.
Result<std::string_view> bytes_of(const std::string& file, const TexturedMaterial& material,
                                  const FileBytes& files, const std::vector<ImageKind>& kinds);

/// The textures of a material, in the order of its parameters.
std::vector<const Texture*> textures_of(const TexturedMaterial& material);

}  // namespace weft::exchange
