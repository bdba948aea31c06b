// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/texture_file.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/image_io/tiled_texture.h"
#include "exchange/blocks/dds.h"
#include "exchange/blocks/decode_blocks.h"
#include "exchange/blocks/encode.h"
#include "exchange/presets/mips.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

constexpr int kBandRows = 64;

std::vector<View<float>> views_of(Image<float>& image) {
  std::vector<View<float>> views;
  for (int p = 0; p < image.planes(); ++p) views.push_back(image.plane(p));
  return views;
}
std::vector<View<const float>> const_views_of(const Image<float>& image) {
  std::vector<View<const float>> views;
  for (int p = 0; p < image.planes(); ++p) views.push_back(image.plane(p));
  return views;
}

int channels_in(const TextureInput& input) {
  return static_cast<int>(input.file.channels.size());
}

SampleType type_of(const Stored& stored) {
  if (stored.bits == 32) return SampleType::kFloat;
  if (stored.is_float()) return SampleType::kHalf;
  return stored.bits == 16 ? SampleType::kUint16 : SampleType::kUint8;
}

Result<void> write_rows(const fs::path& path, const TextureInput& input) {
  const Stored& stored = input.file.stored;
  const WriteOptions options = {
      .type = type_of(stored),
      .compression = Compression::kZip,
      .attributes = input.attributes,
      .pitch_mm = input.pitch_mm,
      .color = stored.color,
  };
  Result<ImageWriter> writer =
      ImageWriter::open(path, input.size, channel_names(input.file.channels.size()), options);
  if (!writer) return std::move(writer).error();
  Image<float> band({input.size.width, std::min(kBandRows, input.size.height)}, channels_in(input));
  for (int y = 0; y < input.size.height; y += kBandRows) {
    std::vector<View<float>> rows = views_of(band);
    for (View<float>& plane : rows)
      plane = plane.crop({0, 0, input.size.width, std::min(kBandRows, input.size.height - y)});
    pack_values(input.file, input.planes, input.facts, y, rows);
    to_samples(input.file, input.facts, rows);
    if (Result<void> ok = writer->write_rows(std::vector<View<const float>>(rows.begin(), rows.end())); !ok)
      return ok;
  }
  return writer->finish();
}

Image<float> values_of(const TextureInput& input) {
  Image<float> values(input.size, channels_in(input));
  pack_values(input.file, input.planes, input.facts, 0, views_of(values));
  return values;
}

Result<void> write_dds(const fs::path& path, const TextureInput& input, int threads) {
  const Stored& stored = input.file.stored;
  const bool is_dx10 = input.is_dx10 || is_dx10_by_default(stored.blocks);
  DdsTexture texture;
  texture.format = stored.blocks;
  texture.is_dx10 = is_dx10;
  texture.is_srgb = is_dx10 && stored.color == ColorSpace::kSrgb;
  Image<float> level = padded_to_whole_blocks(const_views_of(values_of(input)));
  texture.size = level.size();
  const int levels = level_count(texture.size);
  for (int i = 0; i < levels; ++i) {
    Image<float> next;
    if (i + 1 < levels) {
      next = next_level(input.file, level, threads);
      put_lobe(input.file, input.facts, input.lobe, i + 1, next);
    }
    to_samples(input.file, input.facts, views_of(level));
    Result<std::string> blocks = encode_blocks(stored.blocks, const_views_of(level), threads);
    if (!blocks) return std::move(blocks).error();
    texture.levels.push_back(std::move(*blocks));
    level = std::move(next);
  }
  const Result<std::string> bytes = dds_file(texture);
  if (!bytes) return bytes.error();
  return write_file(path, *bytes);
}

// Levels of the channels that are of the lobe.
std::vector<PlaneLevels> lobe_levels_of(const TextureInput& input) {
  std::vector<PlaneLevels> all;
  for (std::size_t c = 0; c < input.file.channels.size() && !input.lobe.empty(); ++c) {
    if (!is_of_lobe(*channel_named(input.file.channels[c]))) continue;
    PresetFile alone = input.file;
    alone.channels = {input.file.channels[c]};
    PlaneLevels one = {.plane = c, .levels = {}};
    for (std::size_t i = 0; i < input.lobe.size(); ++i) {
      one.levels.emplace_back(input.lobe[i].size());
      put_lobe(alone, input.facts, input.lobe, static_cast<int>(i) + 1, one.levels.back());
      to_samples(alone, input.facts, views_of(one.levels.back()));
    }
    all.push_back(std::move(one));
  }
  return all;
}

Result<void> write_tx(const fs::path& path, const TextureInput& input) {
  Image<float> values = values_of(input);
  to_samples(input.file, input.facts, views_of(values));
  const std::vector<PlaneLevels> own_levels = lobe_levels_of(input);
  const TiledTextureOptions options = {.type = type_of(input.file.stored),
                                       .is_periodic = input.is_tile,
                                       .is_prman = input.file.stored.is_prman,
                                       .attributes = input.attributes,
                                       .pitch_mm = input.pitch_mm,
                                       .color = input.file.stored.color,
                                       .own_levels = own_levels};
  return write_tiled_texture(path, const_views_of(values), channel_names(input.file.channels.size()),
                             options);
}

Result<Image<float>> read_dds(const fs::path& path, const TextureInput& input, int threads) {
  const Result<std::string> bytes = read_text(path, std::size_t{1} << 40);
  if (!bytes) return bytes.error();
  const Result<DdsTexture> texture = parse_dds(*bytes, path.string());
  if (!texture) return texture.error();
  Result<Image<float>> decoded =
      decode_blocks(texture->format, texture->levels.front(), texture->size, threads);
  if (!decoded) return decoded;
  // The padding is not of the cloth.
  Image<float> cut(input.size, channels_in(input));
  for (int c = 0; c < cut.planes(); ++c) {
    for (int y = 0; y < cut.height(); ++y)
      std::copy_n(decoded->plane(c).row(y), cut.width(), cut.plane(c).row(y));
  }
  return cut;
}

}  // namespace

Result<void> write_texture(const fs::path& path, const TextureInput& input, int threads) {
  if (input.file.stored.encoding == Encoding::kDds) return write_dds(path, input, threads);
  if (input.file.stored.encoding == Encoding::kTx) return write_tx(path, input);
  return write_rows(path, input);
}

int levels_of(const PresetFile& file, Size size) {
  const Encoding encoding = file.stored.encoding;
  if (encoding == Encoding::kDds) return level_count(whole_blocks(size));
  return encoding == Encoding::kTx ? level_count(size) : 1;
}

Result<Image<float>> read_texture(const fs::path& path, const TextureInput& input, int threads) {
  if (input.file.stored.encoding == Encoding::kDds) return read_dds(path, input, threads);
  Result<LoadedImage> image = read_image(path);
  if (!image) return std::move(image).error();
  if (image->info.size != input.size || image->planes.planes() != channels_in(input)) {
    return Error{ErrorKind::kBadData, "a texture reads back as another one", path.string(),
                 "its size or its channels are not those that were written", "write it again"};
  }
  return std::move(image->planes);
}

}  // namespace weft::exchange
