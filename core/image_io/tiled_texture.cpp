// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/tiled_texture.h"

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescriptionAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "core/base/files.h"
#include "core/image_io/exr_channels.h"
#include "core/image_io/image_source.h"
#include "core/image_io/pack_row.h"

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

Imf::Header texture_header(Size size, const std::vector<std::string>& channels,
                           const TiledTextureOptions& options) {
  Imf::Header header = exr_header({size,
                                   channels,
                                   {.type = options.type,
                                    .compression = Compression::kZip,
                                    .attributes = options.attributes,
                                    .pitch_mm = options.pitch_mm,
                                    .color = options.color}});
  header.setTileDescription(Imf::TileDescription(kTilePx, kTilePx, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
  header.insert("textureformat", Imf::StringAttribute("Plain Texture"));
  header.insert("wrapmodes", Imf::StringAttribute(options.is_periodic ? "periodic,periodic" : "clamp,clamp"));
  if (options.is_prman) {
    header.insert("PixarTextureFormat", Imf::StringAttribute("Plain Texture"));
    header.insert("fovcot",
                  Imf::FloatAttribute(static_cast<float>(size.width) / static_cast<float>(size.height)));
  }
  return header;
}

void write_level(const Level& level, int number, const std::vector<std::string>& channels, SampleType type,
                 Imf::TiledOutputFile& output) {
  const std::size_t sample = sample_bytes(type), pixel = sample * channels.size();
  std::vector<std::byte> packed(level.samples.size() * sample);
  const float* samples = level.samples.data();
  pack_row({&samples, 1}, level.samples.size(), type, packed.data());
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    auto* first = reinterpret_cast<char*>(packed.data() + c * sample);
    frame.insert(channels[c], Imf::Slice(type == SampleType::kHalf ? Imf::HALF : Imf::FLOAT, first, pixel,
                                         pixel * static_cast<std::size_t>(level.size.width)));
  }
  output.setFrameBuffer(frame);
  output.writeTiles(0, output.numXTiles(number) - 1, 0, output.numYTiles(number) - 1, number);
}

/// The bytes of a file that OpenEXR writes.
class Memory : public Imf::OStream {
 public:
  Memory() : OStream("texture") {}
  void write(const char c[], int n) override {
    const auto count = static_cast<std::size_t>(n);
    if (bytes_.size() < at_ + count) bytes_.resize(at_ + count);
    std::copy_n(c, count, bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ += count;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t offset) override { at_ = offset; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace

// Into memory first: threads of OpenEXR wait for each other for ever where a disk is full.
Result<void> write_tiled_texture(const fs::path& file, std::span<const View<const float>> planes,
                                 const std::vector<std::string>& channels,
                                 const TiledTextureOptions& options) try {
  const bool is_float = options.type == SampleType::kHalf || options.type == SampleType::kFloat;
  if (planes.empty() || planes.size() != channels.size() || planes[0].empty() || !is_float ||
      !are_whole(options.own_levels, planes[0].size(), planes.size())) {
    return Error{ErrorKind::kUsage, "cannot write such a texture", file.string(),
                 "it has no planes, levels of other sizes, or samples that are neither half nor float",
                 "choose half or float"};
  }
  Memory memory;
  Level level = first_level(planes);
  {
    Imf::TiledOutputFile output(memory, texture_header(level.size, channels, options), exr_threads());
    for (int number = 0;; ++number) {
      write_level(level, number, channels, options.type, output);
      if (level.size == Size{1, 1}) break;
      level = next_level(level, planes.size());
      put_own(options.own_levels, static_cast<std::size_t>(number) + 1, planes.size(), level);
    }
  }  // writes where tiles begin
  return write_file(file, memory.bytes());
} catch (const std::exception& refusal) {
  return Error{ErrorKind::kInputOutput, "cannot encode", file.string(), library_reason(refusal.what()),
               "choose another format"};
}

}  // namespace weft
