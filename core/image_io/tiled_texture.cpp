// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/tiled_texture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "core/files.h"
#include "core/image_io/oiio.h"
#include "core/image_io/spec_words.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

constexpr int kTilePx = 64;

/// A level with its channels side by side.
struct Level {
  Size size;
  std::vector<float> samples;
};

Level first_level(std::span<const View<const float>> planes) {
  Level level = {planes[0].size(), {}};
  level.samples.resize(static_cast<std::size_t>(level.size.pixels()) * planes.size());
  std::size_t i = 0;
  for (int y = 0; y < level.size.height; ++y) {
    for (int x = 0; x < level.size.width; ++x) {
      for (const View<const float>& plane : planes) level.samples[i++] = plane(x, y);
    }
  }
  return level;
}

/// Which pixels of a line a coarser one covers: two, or three at the end of an odd line.
struct Cover {
  int first = 0, last = 0;
};
Cover cover_of(int i, int coarse, int fine) {
  if (coarse == fine) return {i, i};
  return {2 * i, i + 1 == coarse ? fine - 1 : 2 * i + 1};
}

/// Sides halved and rounded down, never below 1; each pixel is the mean of those that it covers.
Level next_level(const Level& fine, std::size_t channels) {
  Level level = {{std::max(1, fine.size.width / 2), std::max(1, fine.size.height / 2)}, {}};
  level.samples.resize(static_cast<std::size_t>(level.size.pixels()) * channels);
  std::vector<double> sums(channels);
  std::size_t out = 0;
  for (int y = 0; y < level.size.height; ++y) {
    const Cover rows = cover_of(y, level.size.height, fine.size.height);
    for (int x = 0; x < level.size.width; ++x) {
      const Cover columns = cover_of(x, level.size.width, fine.size.width);
      std::fill(sums.begin(), sums.end(), 0.0);
      for (int j = rows.first; j <= rows.last; ++j) {
        for (int i = columns.first; i <= columns.last; ++i) {
          const std::size_t at = (static_cast<std::size_t>(j) * static_cast<std::size_t>(fine.size.width) +
                                  static_cast<std::size_t>(i)) *
                                 channels;
          for (std::size_t c = 0; c < channels; ++c) sums[c] += static_cast<double>(fine.samples[at + c]);
        }
      }
      const int count = (rows.last - rows.first + 1) * (columns.last - columns.first + 1);
      for (std::size_t c = 0; c < channels; ++c) level.samples[out++] = static_cast<float>(sums[c] / count);
    }
  }
  return level;
}

void put_own(std::span<const PlaneLevels> own, std::size_t number, std::size_t channels, Level& level) {
  for (const PlaneLevels& each : own) {
    const Image<float>& from = each.levels[number - 1];
    std::size_t at = each.plane;
    for (int y = 0; y < level.size.height; ++y) {
      for (int x = 0; x < level.size.width; ++x, at += channels) level.samples[at] = from(x, y);
    }
  }
}

bool are_whole(std::span<const PlaneLevels> own, Size size, std::size_t channels) {
  for (const PlaneLevels& each : own) {
    Size level = size;
    for (std::size_t i = 0; level != Size{1, 1}; ++i) {
      level = {std::max(1, level.width / 2), std::max(1, level.height / 2)};
      if (i == each.levels.size() || each.levels[i].size() != level) return false;
    }
    if (each.plane >= channels) return false;
  }
  return true;
}

OIIO::ImageSpec spec_of_texture(Size size, const std::vector<std::string>& channels,
                                const TiledTextureOptions& options) {
  OIIO::ImageSpec spec(size.width, size.height, static_cast<int>(channels.size()),
                       options.type == SampleType::kHalf ? OIIO::TypeHalf : OIIO::TypeFloat);
  spec.channelnames = channels;
  spec.tile_width = spec.tile_height = kTilePx;
  for (const auto& [key, text] : options.attributes) spec.attribute(key, text);
  spec.attribute("compression", "zip");
  spec.attribute("textureformat", "Plain Texture");
  spec.attribute("wrapmodes", options.is_periodic ? "periodic,periodic" : "clamp,clamp");
  if (options.is_prman) {
    spec.attribute("PixarTextureFormat", "Plain Texture");
    spec.attribute("fovcot", static_cast<float>(size.width) / static_cast<float>(size.height));
  }
  // A date of another type than text is dropped; without one, OpenImageIO would write the present.
  spec.attribute("DateTime", 0);
  add_density(spec, "openexr", options.pitch_mm);
  add_color(spec, "openexr", options.color);
  return spec;
}

Error refused(const fs::path& file, const std::string& why) {
  return {ErrorKind::kInputOutput, "cannot encode", file.string(), oiio_reason(why), "choose another format"};
}

}  // namespace

// Into memory first: threads of OpenEXR wait for each other for ever where a disk is full.
Result<void> write_tiled_texture(const fs::path& file, std::span<const View<const float>> planes,
                                 const std::vector<std::string>& channels,
                                 const TiledTextureOptions& options) {
  prepare_oiio();
  const bool is_float = options.type == SampleType::kHalf || options.type == SampleType::kFloat;
  if (planes.empty() || planes.size() != channels.size() || planes[0].empty() || !is_float ||
      !are_whole(options.own_levels, planes[0].size(), planes.size())) {
    return Error{ErrorKind::kUsage, "cannot write such a texture", file.string(),
                 "it has no planes, levels of other sizes, or samples that are neither half nor float",
                 "choose half or float"};
  }
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("openexr");
  if (!output) return refused(file, OIIO::geterror());
  if (!output->set_ioproxy(&sink)) return refused(file, output->geterror());
  const std::string name = file.string();
  Level level = first_level(planes);
  std::size_t number = 0;
  OIIO::ImageOutput::OpenMode mode = OIIO::ImageOutput::Create;
  while (true) {
    const OIIO::ImageSpec spec = spec_of_texture(level.size, channels, options);
    if (!output->open(name, spec, mode)) return refused(file, output->geterror());
    if (!output->write_image(OIIO::TypeFloat, level.samples.data())) return refused(file, output->geterror());
    if (level.size == Size{1, 1}) break;
    level = next_level(level, planes.size());
    put_own(options.own_levels, ++number, planes.size(), level);
    mode = OIIO::ImageOutput::AppendMIPLevel;
  }
  if (!output->close()) return refused(file, output->geterror());
  return write_file(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace weft
