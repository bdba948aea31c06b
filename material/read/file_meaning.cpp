// SPDX-License-Identifier: Apache-2.0
#include "material/read/file_meaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <utility>

#include "core/base/files.h"
#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "core/image_io/linear_image.h"
#include "exchange/blocks/dds.h"
#include "exchange/blocks/decode_blocks.h"
#include "exchange/presets/export_facts.h"
#include "exchange/presets/pack.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDds = "dds";
constexpr int kMostFolders = 3;  // between a texture and its export.json: layers/NAME/FILE

// --- blocks

bool is_dds(const fs::path& file) {
  std::array<char, 4> magic = {};
  std::ifstream in(file, std::ios::binary);
  in.read(magic.data(), magic.size());
  return in.good() && std::string_view(magic.data(), magic.size()) == "DDS ";
}

Result<exchange::DdsTexture> read_dds_texture(const fs::path& file) {
  const Result<std::string> bytes = read_text(file, std::size_t{1} << 32);
  if (!bytes) return bytes.error();
  return exchange::parse_dds(*bytes, file.string());
}

ImageFileInfo info_of(const exchange::DdsTexture& texture) {
  const auto channels = static_cast<std::size_t>(exchange::channels_of(texture.format));
  ImageFileInfo info;
  info.size = texture.size;
  info.type = SampleType::kUint8;
  info.format = kDds;
  const std::vector<std::string> names = {"R", "G", "B", "A"};
  info.channels.assign(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(channels));
  info.color = texture.is_srgb ? ColorSpace::kSrgb : ColorSpace::kData;
  return info;
}

Result<ImageFileInfo> info_of_file(const fs::path& file) {
  if (!is_dds(file)) return read_image_info(file);
  const Result<exchange::DdsTexture> texture = read_dds_texture(file);
  if (!texture) return texture.error();
  return info_of(*texture);
}

// --- export.json

// The entry of a file in the nearest export.json above it.
std::optional<exchange::ExportedTexture> listing_of(const fs::path& file) {
  const fs::path path = fs::absolute(file).lexically_normal();
  fs::path folder = path.parent_path();
  for (int i = 0; i < kMostFolders; ++i, folder = folder.parent_path()) {
    if (!is_there(folder / exchange::kExportProduct.document)) continue;
    const Result<exchange::ExportFacts> facts = exchange::read_export(folder);
    if (!facts) return std::nullopt;
    const std::string name = path.lexically_relative(folder).generic_string();
    const auto found = std::ranges::find(facts->files, name, &exchange::ExportedTexture::file);
    return found == facts->files.end() ? std::nullopt : std::optional(*found);
  }
  return std::nullopt;
}

template <typename Names>
std::size_t index_among(const Names& names, const std::string& word) {
  const auto found = std::ranges::find(names, word);
  return found == names.end() ? 0 : static_cast<std::size_t>(found - names.begin());
}

// Whether the file is still the one that is listed; blocks are padded from its size.
bool is_as_listed(const exchange::ExportedTexture& listed, const ImageFileInfo& info) {
  const bool is_alike =
      info.size == (info.format == kDds ? exchange::whole_blocks(listed.size) : listed.size);
  return is_alike && listed.channels.size() <= info.channels.size();
}

void take_listing(const exchange::ExportedTexture& listed, FileMeaning& meaning) {
  meaning.is_listed = true;
  meaning.direction =
      static_cast<exchange::NormalDirection>(index_among(exchange::kNormalDirectionNames, listed.direction));
  if (!listed.roughness.empty()) {
    meaning.roughness = static_cast<exchange::RoughnessConvention>(
        index_among(exchange::kRoughnessConventionNames, listed.roughness));
  }
  const bool is_srgb = listed.color == ColorSpace::kSrgb;
  for (std::size_t c = 0; c < listed.channels.size(); ++c) {
    const exchange::ExportedChannel& written = listed.channels[c];
    const exchange::Channel* channel = exchange::channel_named(written.name);
    if (channel == nullptr) continue;
    ChannelMeaning& of = meaning.channels[c];
    of.is = channel->name;
    of.is_srgb = is_srgb && channel->kind == exchange::ChannelKind::kColor;
    of.range = written.at_0 && written.at_1 ? exchange::ChannelRange{*written.at_0, *written.at_1}
                                            : exchange::ChannelRange{};
  }
}

// --- names of channels

// X, Y, Z of a file, or of one of its layers.
void take_directions(FileMeaning& meaning) {
  const std::vector<std::string>& names = meaning.info.channels;
  for (const std::string& name : names) {
    if (name != "X" && !name.ends_with(".X")) continue;
    const std::string layer = name.substr(0, name.size() - 1);
    std::vector<std::size_t> places;
    for (const char* axis : {"X", "Y", "Z"}) {
      const auto found = std::ranges::find(names, layer + axis);
      if (found != names.end()) places.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (places.size() < 3) continue;
    const std::array<const char*, 3> parts = {"normal.x", "normal.y", "normal.z"};
    for (std::size_t i = 0; i < 3; ++i) meaning.channels[places[i]].is = parts[i];
    return;
  }
}

// --- normals

using Planes = std::array<View<const float>, 3>;

constexpr double kRounding = 1e-3;  // of half floats about 0

Vec3 unpacked(const Vec3& v) {
  return {2 * v.x - 1, 2 * v.y - 1, 2 * v.z - 1};
}

template <typename Visit>
void for_each_direction(const Planes& planes, const Visit& visit) {
  for (int y = 0; y < planes[0].height(); ++y) {
    for (int x = 0; x < planes[0].width(); ++x) {
      const Vec3 v = {planes[0](x, y), planes[1](x, y), planes[2](x, y)};
      if (std::isfinite(v.x + v.y + v.z) && (v.x != 0 || v.y != 0 || v.z != 0)) visit(v);
    }
  }
}

}  // namespace

double ChannelMeaning::value_of(double sample) const {
  return in_range(is_srgb ? rec709_of_srgb({sample, sample, sample})[0] : sample);
}

double ChannelMeaning::in_range(double sample) const {
  return range ? range->least + (range->most - range->least) * sample : sample;
}

std::optional<std::vector<std::size_t>> FileMeaning::find(const std::vector<std::string>& wanted) const {
  std::vector<std::size_t> places;
  for (const std::string& name : wanted) {
    const auto found = std::ranges::find(channels, name, &ChannelMeaning::is);
    if (found == channels.end()) return std::nullopt;
    places.push_back(static_cast<std::size_t>(found - channels.begin()));
  }
  return places;
}

Result<FileMeaning> meaning_of(const fs::path& file) {
  Result<ImageFileInfo> info = info_of_file(file);
  if (!info) return std::move(info).error();
  FileMeaning meaning = {.info = std::move(*info), .channels = {}};
  meaning.channels.resize(meaning.info.channels.size());
  if (const std::optional<exchange::ExportedTexture> listed = listing_of(file);
      listed && is_as_listed(*listed, meaning.info)) {
    meaning.info.size = listed->size;
    take_listing(*listed, meaning);
    return meaning;
  }
  take_directions(meaning);
  for (std::size_t c = 0; c < meaning.channels.size(); ++c) {
    const std::string& name = meaning.info.channels[c];
    const bool can_be_color = name == "R" || name == "G" || name == "B" || name == "Y";
    meaning.channels[c].is_srgb = can_be_color && transfer_of(meaning.info) == Transfer::kSrgb;
    if (name == "openness") meaning.channels[c].is = "occlusion";
    if (exchange::channel_named(name) != nullptr) meaning.channels[c].is = name;
  }
  return meaning;
}

Result<LoadedImage> read_samples(const fs::path& file) {
  if (!is_dds(file)) return read_image(file);
  const Result<exchange::DdsTexture> texture = read_dds_texture(file);
  if (!texture) return texture.error();
  Result<Image<float>> planes =
      exchange::decode_blocks(texture->format, texture->levels.front(), texture->size);
  if (!planes) return std::move(planes).error();
  Result<FileMeaning> meaning = meaning_of(file);
  if (!meaning) return std::move(meaning).error();
  LoadedImage image = {meaning->info, Image<float>(meaning->info.size, planes->planes())};
  for (int c = 0; c < planes->planes(); ++c) {
    for (int y = 0; y < image.planes.height(); ++y)
      std::copy_n(planes->plane(c).row(y), image.planes.width(), image.planes.plane(c).row(y));
  }
  return image;
}

bool are_packed_normals(const Planes& planes) {
  double from_signed = 0, from_packed = 0;
  bool is_below = false;
  for_each_direction(planes, [&](const Vec3& v) {
    is_below = is_below || std::min({v.x, v.y, v.z}) < -kRounding;
    from_signed += std::abs(length(v) - 1);
    from_packed += std::abs(length(unpacked(v)) - 1);
  });
  return !is_below && from_packed < from_signed;
}

bool are_unit_normals(const Planes& planes, bool packed) {
  std::int64_t pixels = 0, units = 0;
  for_each_direction(planes, [&](const Vec3& v) {
    const Vec3 n = packed ? unpacked(v) : v;
    ++pixels;
    units += n.z > -0.1 && std::abs(length(n) - 1) < 0.1;
  });
  return pixels > 0 && 100 * units >= 98 * pixels;
}

}  // namespace weft::material
