// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"
#include "exchange/presets/mips.h"
#include "exchange/presets/pack.h"

namespace weft::exchange {

/// What a texture is made of: a file of a preset, and the maps of a cloth.
struct TextureInput {
  const PresetFile& file;
  const SourcePlanes& planes;
  ChannelFacts facts;
  LobeLevels lobe = {};  ///< of the cloth at this size; empty: levels are means
  Size size;
  PixelPitch pitch_mm = {};
  bool is_tile = false;
  bool is_dx10 = false;  ///< of a dds: always with the header of DX10, and sRGB said in it
  ImageAttributes attributes = {};
};

/// Writes the texture. Rows are packed and written band by band, but for dds and tx, which need whole planes
/// for their mips. The same bytes for any number of threads. Errors: of ImageWriter and of write_file().
Result<void> write_texture(const std::filesystem::path& path, const TextureInput& input, int threads);

/// Mips that `path` has: 1 but for dds and tx.
int levels_of(const PresetFile& file, Size size);

/// Samples of a texture's largest level as any reader has them, 0 to 1 or, of floats, as they are: a plane a
/// channel. kBadData where the file is not what write_texture() makes.
Result<Image<float>> read_texture(const std::filesystem::path& path, const TextureInput& input, int threads);

}  // namespace weft::exchange
