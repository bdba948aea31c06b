// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/image_io/image_source.h"

namespace weft {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

using Opened = Result<std::unique_ptr<ImageSource>>;

struct Signature {
  std::string_view bytes;
  Opened (*open)(const fs::path&);
};

constexpr std::array kSignatures = {
    Signature{"\x76\x2f\x31\x01"sv, open_exr}, Signature{"II*\0"sv, open_tiff},
    Signature{"MM\0*"sv, open_tiff},           Signature{"II+\0"sv, open_tiff},
    Signature{"MM\0+"sv, open_tiff},           Signature{"\x89PNG\r\n\x1a\n"sv, open_png},
    Signature{"\xff\xd8\xff"sv, open_jpeg}};

// How many bytes follow the chunk that ends a PNG, by the lengths of its chunks; nothing where it has no end,
// since the rows may all be there and yet something is missing.
std::optional<std::uintmax_t> bytes_behind_png(std::ifstream& in, std::uintmax_t file_bytes) {
  constexpr std::uintmax_t kSignature = 8, kAroundData = 12;
  std::array<unsigned char, 8> chunk = {};
  in.clear();
  for (std::uintmax_t at = kSignature; at + kAroundData <= file_bytes;) {
    in.seekg(static_cast<std::streamoff>(at));
    if (!in.read(reinterpret_cast<char*>(chunk.data()), chunk.size())) return std::nullopt;
    const std::uintmax_t length = std::uintmax_t{chunk[0]} << 24 | std::uintmax_t{chunk[1]} << 16 |
                                  std::uintmax_t{chunk[2]} << 8 | chunk[3];
    at += length + kAroundData;
    if (std::memcmp(&chunk[4], "IEND", 4) == 0)
      return at <= file_bytes ? std::optional(file_bytes - at) : std::nullopt;
  }
  return std::nullopt;
}

Opened open_whole_png(std::ifstream& in, const fs::path& file, std::uintmax_t file_bytes) {
  const std::optional<std::uintmax_t> behind = bytes_behind_png(in, file_bytes);
  if (!behind) return bad_image(file, "its end is missing");
  Opened source = open_png(file);
  if (source && *behind > 0) (*source)->remark(fmt::format("{} bytes behind its end", *behind));
  return source;
}

/// By its first bytes: its ending may say anything.
Opened open_image(const fs::path& file) {
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(file, failed);  // a folder has none
  if (failed) return cannot_read(file, failed.value());
  std::ifstream in(file, std::ios::binary);
  if (!in) return cannot_read(file, errno);
  std::array<char, 8> first = {};
  in.read(first.data(), first.size());
  const std::string_view start(first.data(), static_cast<std::size_t>(in.gcount()));
  if (start.empty()) return bad_image(file, "it is empty");
  for (const Signature& signature : kSignatures) {
    if (!start.starts_with(signature.bytes)) continue;
    if (signature.open == open_png) return open_whole_png(in, file, bytes);
    in.close();
    return signature.open(file);
  }
  return bad_image(file, "it is no EXR, TIFF, PNG or JPEG file");
}

Result<LoadedImage> read_pixels(ImageSource& source, const fs::path& file) {
  const Size size = source.info().size;
  const int channels = static_cast<int>(source.info().channels.size());
  const double padded_width = static_cast<double>(detail::padded_stride(size.width));
  const double needed = 4.0 * channels * padded_width * size.height + source.scratch_bytes();
  const double available = static_cast<double>(available_memory_bytes());
  if (needed > available) {
    return Error{ErrorKind::kTryAgain, "image does not fit into memory", file.string(),
                 fmt::format("{} x {} pixels with {} channels need {:.1f} GB, {:.1f} GB are free", size.width,
                             size.height, channels, needed * 1e-9, available * 1e-9),
                 "end other programs or use a larger machine"};
  }
  LoadedImage loaded{source.info(), Image<float>(size, channels)};
  if (const std::string why = source.read(loaded.planes); !why.empty()) return bad_image(file, why);
  return loaded;
}

}  // namespace

int choose_part(std::vector<PicturePart> parts, ImageFileInfo& info) {
  if (parts.empty()) return 0;
  const auto largest =
      std::ranges::max_element(parts, {}, [](const PicturePart& p) { return p.size.pixels(); });
  const PicturePart chosen = *largest;
  parts.erase(largest);
  for (const PicturePart& other : parts) {
    if (other.size.pixels() == chosen.size.pixels()) info.alike.push_back(other.words);
  }
  if (!parts.empty() || chosen.number > 0) info.remarks.push_back("all but " + chosen.words);
  return chosen.number;
}

Error bad_image(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "cannot read the image", file.string(), std::move(why),
          "write or copy the file again"};
}

std::string library_reason(const std::string& message) {
  const std::size_t end = message.find('\n');
  std::string line = message.substr(0, end);
  while (!line.empty() && (line.back() == '.' || line.back() == ' ')) line.pop_back();
  return line.empty() ? "the file format library gives no reason" : line;
}

void unpack_counts(const std::uint8_t* samples, std::size_t step, View<float> row) {
  constexpr float kUnit = 1.0f / 255;
  float* out = row.row(0);
  for (int x = 0; x < row.width(); ++x, samples += step) out[x] = kUnit * static_cast<float>(*samples);
}

void unpack_counts(const std::uint16_t* samples, std::size_t step, View<float> row) {
  constexpr float kUnit = 1.0f / 65535;
  float* out = row.row(0);
  for (int x = 0; x < row.width(); ++x, samples += step) out[x] = kUnit * static_cast<float>(*samples);
}

bool tile_is_too_large(std::int64_t width, std::int64_t height, Size image) {
  constexpr double kLarge = 4096.0 * 4096;
  const double pixels = static_cast<double>(width) * static_cast<double>(height);
  return pixels > std::max(kLarge, static_cast<double>(image.pixels()));
}

ImageAttributes attributes_of_texts(ImageAttributes texts) {
  const auto description = texts.find("ImageDescription");
  if (description == texts.end()) return texts;
  const nlohmann::json ours = nlohmann::json::parse(description->second, nullptr, false);
  const bool is_ours = ours.is_object() && std::all_of(ours.begin(), ours.end(),
                                                       [](const nlohmann::json& v) { return v.is_string(); });
  if (is_ours) return ours.get<ImageAttributes>();
  if (description->second.empty()) texts.erase(description);
  return texts;
}

PixelPitch pitch_of_density(double x, double y, double unit_mm) {
  const PixelPitch pitch = {unit_mm / x, unit_mm / y};
  const bool is_one = x > 0 && y > 0 && unit_mm > 0 && std::isfinite(pitch[0]) && std::isfinite(pitch[1]);
  return is_one ? pitch : PixelPitch();
}

View<const float> LoadedImage::channel(std::string_view name) const {
  const auto found = std::find(info.channels.begin(), info.channels.end(), name);
  if (found == info.channels.end()) return {};
  return planes.plane(static_cast<int>(found - info.channels.begin()));
}

Result<ImageFileInfo> read_image_info(const fs::path& file) try {
  const Opened opened = open_image(file);
  if (!opened) return opened.error();
  return (*opened)->info();
} catch (const std::exception& damage) {
  return bad_image(file, library_reason(damage.what()));
}

Result<LoadedImage> read_image(const fs::path& file) try {
  const Opened opened = open_image(file);
  if (!opened) return opened.error();
  return read_pixels(**opened, file);
} catch (const std::exception& damage) {
  return bad_image(file, library_reason(damage.what()));
}

}  // namespace weft
