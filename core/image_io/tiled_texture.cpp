// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/tiled_texture.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <fstream>
#include <sstream>

#include "core/files.h"
#include "core/image_io/oiio.h"
#include "core/image_io/spec_words.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

constexpr int kTilePx = 64;

OIIO::ImageSpec config_of(const TiledTextureOptions& options) {
  OIIO::ImageSpec config;
  config.set_format(options.type == SampleType::kHalf ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
  config.tile_width = config.tile_height = kTilePx;
  config.attribute("maketx:fileformatname", "openexr");
  config.attribute("compression", "zip");
  config.attribute("wrapmodes", options.is_periodic ? "periodic,periodic" : "clamp,clamp");
  config.attribute("maketx:prman_metadata", options.is_prman ? 1 : 0);
  // What would be the present and the program's own words.
  config.attribute("DateTime", "1980:01:01 00:00:00");
  config.attribute("Software", "weft");
  return config;
}

OIIO::ImageBuf buffer_of(std::span<const View<const float>> planes, const std::vector<std::string>& channels,
                         const TiledTextureOptions& options) {
  OIIO::ImageSpec spec(planes[0].width(), planes[0].height(), static_cast<int>(planes.size()),
                       OIIO::TypeFloat);
  spec.channelnames = channels;
  for (const auto& [key, text] : options.attributes) spec.attribute(key, text);
  add_density(spec, "openexr", options.pitch_mm);
  add_color(spec, "openexr", options.color);
  OIIO::ImageBuf buffer(spec);
  std::vector<float> row(planes.size() * static_cast<std::size_t>(spec.width));
  for (int y = 0; y < spec.height; ++y) {
    for (std::size_t c = 0; c < planes.size(); ++c) {
      const float* samples = planes[c].row(y);
      for (int x = 0; x < spec.width; ++x) row[static_cast<std::size_t>(x) * planes.size() + c] = samples[x];
    }
    buffer.set_pixels(OIIO::ROI(0, spec.width, y, y + 1), OIIO::TypeFloat, row.data());
  }
  return buffer;
}

}  // namespace

Result<void> write_tiled_texture(const fs::path& file, std::span<const View<const float>> planes,
                                 const std::vector<std::string>& channels,
                                 const TiledTextureOptions& options) try {
  prepare_oiio();
  const bool is_float = options.type == SampleType::kHalf || options.type == SampleType::kFloat;
  if (planes.empty() || planes.size() != channels.size() || planes[0].empty() || !is_float) {
    return Error{ErrorKind::kUsage, "cannot write such a texture", file.string(),
                 "it has no planes, or samples that are neither half nor float", "choose half or float"};
  }
  fs::path aside = file;
  aside += ".partial";
  // What cannot be created is told by the system's own reason.
  if (!std::ofstream(aside, std::ios::binary)) return cannot_write(file, errno);
  std::ostringstream said;
  const OIIO::ImageBuf buffer = buffer_of(planes, channels, options);
  const bool made = OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, buffer,
                                                     aside.string(), config_of(options), &said);
  if (!made) {
    ::unlink(aside.c_str());
    return Error{ErrorKind::kInputOutput, "cannot write", file.string(), oiio_reason(OIIO::geterror()),
                 "free disk space or choose another disk"};
  }
  if (::rename(aside.c_str(), file.c_str()) != 0) return cannot_write(file, errno);
  return {};
} catch (const std::exception& failure) {
  return Error{ErrorKind::kInputOutput, "cannot write", file.string(), failure.what(),
               "free disk space or choose another disk"};
}

}  // namespace weft
