// SPDX-License-Identifier: Apache-2.0
#include "exchange/image_kind.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace weft::exchange {

namespace {

std::uint32_t big_endian_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

std::string names_of(const std::vector<ImageKind>& kinds) {
  std::string names;
  for (const ImageKind kind : kinds) names += (names.empty() ? "" : " or ") + std::string(name_of(kind));
  return names;
}

}  // namespace

const char* name_of(ImageKind kind) {
  static constexpr std::array<const char*, 4> kNames = {"PNG", "JPEG", "TIFF", "EXR"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::optional<ImageKind> kind_of_image(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return ImageKind::kPng;
  if (bytes.starts_with("\xff\xd8\xff")) return ImageKind::kJpeg;
  if (bytes.starts_with(std::string_view("II*\0", 4)) || bytes.starts_with(std::string_view("MM\0*", 4))) {
    return ImageKind::kTiff;
  }
  if (bytes.starts_with("\x76\x2f\x31\x01")) return ImageKind::kExr;
  return std::nullopt;
}

std::optional<ImageKind> kind_of_file_name(std::string_view file) {
  const std::size_t dot = file.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  std::string extension(file.substr(dot + 1));
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  if (extension == "png") return ImageKind::kPng;
  if (extension == "jpg" || extension == "jpeg") return ImageKind::kJpeg;
  if (extension == "tif" || extension == "tiff") return ImageKind::kTiff;
  if (extension == "exr") return ImageKind::kExr;
  return std::nullopt;
}

std::optional<Size> png_size(std::string_view bytes) {
  if (kind_of_image(bytes) != ImageKind::kPng || bytes.size() < 24 || bytes.substr(12, 4) != "IHDR") {
    return std::nullopt;
  }
  return Size{static_cast<int>(big_endian_at(bytes, 16)), static_cast<int>(big_endian_at(bytes, 20))};
}

Result<std::string_view> bytes_of(const std::string& file, const TexturedMaterial& material,
                                  const FileBytes& files, const std::vector<ImageKind>& kinds) {
  const auto bad = [&](const std::string& why, const std::string& remedy) {
    return Error{ErrorKind::kBadData, "a texture cannot be taken along", file, why, remedy};
  };
  const auto found = files.find(file);
  if (found == files.end()) return bad("its bytes were not given", "write it before the document");
  const auto kind = kind_of_image(found->second);
  if (!kind || std::ranges::find(kinds, *kind) == kinds.end()) {
    return bad(kind ? std::string("it is ") + name_of(*kind) : "it is no image",
               "write it as " + names_of(kinds));
  }
  const auto size = png_size(found->second);
  for (const Texture* texture : textures_of(material)) {
    if (!size || texture->file != file || texture->size == *size) continue;
    return bad("it has " + std::to_string(size->width) + " x " + std::to_string(size->height) +
                   " pixels, not " + std::to_string(texture->size.width) + " x " +
                   std::to_string(texture->size.height),
               "write it again with the material");
  }
  return found->second;
}

std::vector<const Texture*> textures_of(const TexturedMaterial& material) {
  std::vector<const Texture*> textures;
  if (material.base_color.texture) textures.push_back(&*material.base_color.texture);
  for (const auto* parameter :
       {&material.normal, &material.height_mm, &material.roughness, &material.occlusion, &material.opacity,
        &material.f0, &material.metallic, &material.anisotropy, &material.anisotropy_direction,
        &material.sheen_color, &material.sheen_roughness}) {
    if (*parameter && (*parameter)->texture) textures.push_back(&*(*parameter)->texture);
  }
  return textures;
}

}  // namespace weft::exchange
