// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/files.h"
#include "core/image_io/color_profile.h"
#include "core/image_io/image_io.h"
#include "core/image_io/oiio.h"

namespace weft {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

struct Signature {
  std::string_view bytes;
  const char* format;
};

constexpr std::array kSignatures = {Signature{"\x76\x2f\x31\x01"sv, "openexr"},
                                    Signature{"II*\0"sv, "tiff"},
                                    Signature{"MM\0*"sv, "tiff"},
                                    Signature{"II+\0"sv, "tiff"},
                                    Signature{"MM\0+"sv, "tiff"},
                                    Signature{"\x89PNG\r\n\x1a\n"sv, "png"},
                                    Signature{"\xff\xd8\xff"sv, "jpeg"}};

// Asked for beforehand, because libpng prints a line of its own when a file stops early.
constexpr std::string_view kPngEnd = "\0\0\0\0IEND\xae\x42\x60\x82"sv;

Error bad_data(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "cannot read the image", file.string(), std::move(why),
          "write or copy the file again"};
}

bool ends_in(std::ifstream& in, std::string_view wanted) {
  std::string last(wanted.size(), ' ');
  in.clear();
  in.seekg(-static_cast<std::streamoff>(last.size()), std::ios::end);
  in.read(last.data(), static_cast<std::streamsize>(last.size()));
  return in.good() && last == wanted;
}

/// The name of the file's format, from its first bytes: its ending may say anything.
Result<std::string> format_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return cannot_read(file, errno);
  std::array<char, 8> first = {};
  in.read(first.data(), first.size());
  const std::string_view start(first.data(), static_cast<std::size_t>(in.gcount()));
  if (start.empty()) return bad_data(file, "it is empty");
  for (const Signature& signature : kSignatures) {
    if (!start.starts_with(signature.bytes)) continue;
    if (signature.format == "png"sv && !ends_in(in, kPngEnd)) return bad_data(file, "its end is missing");
    return std::string(signature.format);
  }
  return bad_data(file, "it is no EXR, TIFF, PNG or JPEG file");
}

SampleType sample_type(const OIIO::ImageSpec& spec) {
  const auto type_of = [](const OIIO::TypeDesc& type) {
    switch (type.basetype) {
      case OIIO::TypeDesc::UINT8:
        return SampleType::kUint8;
      case OIIO::TypeDesc::UINT16:
        return SampleType::kUint16;
      case OIIO::TypeDesc::HALF:
        return SampleType::kHalf;
      default:
        return SampleType::kFloat;
    }
  };
  SampleType widest = type_of(spec.format);
  for (const OIIO::TypeDesc& type : spec.channelformats) widest = std::max(widest, type_of(type));
  return widest;
}

ImageAttributes attributes_of(const OIIO::ImageSpec& spec, const std::string& format) {
  ImageAttributes attributes;
  for (const OIIO::ParamValue& each : spec.extra_attribs) {
    const std::string name = each.name().string();
    const std::string prefix = name.substr(0, name.find(':'));
    const bool about_the_file = prefix == "oiio" || prefix == format || name == "compression" ||
                                name == "planarconfig" || name == "ResolutionUnit" || prefix == "ICCProfile";
    if (each.type() == OIIO::TypeString && !about_the_file) attributes[name] = each.get_string();
  }
  if (format == "openexr") return attributes;

  const nlohmann::json ours = nlohmann::json::parse(attributes["ImageDescription"], nullptr, false);
  const bool texts = ours.is_object() && std::all_of(ours.begin(), ours.end(),
                                                     [](const nlohmann::json& v) { return v.is_string(); });
  if (texts) return ours.get<ImageAttributes>();
  if (attributes["ImageDescription"].empty()) attributes.erase("ImageDescription");
  return attributes;
}

/// EXR has pixels an inch and nothing about the unit.
PixelPitch pitch_of(const OIIO::ImageSpec& spec, const std::string& format) {
  const double x = static_cast<double>(spec.get_float_attribute("XResolution"));
  const double aspect = static_cast<double>(spec.get_float_attribute("PixelAspectRatio", 1));
  const bool is_exr = format == "openexr";
  const double y = is_exr ? x * aspect : static_cast<double>(spec.get_float_attribute("YResolution"));
  const std::string unit = is_exr ? "in" : spec.get_string_attribute("ResolutionUnit").c_str();
  const double mm = unit == "in" || unit == "inch" ? 25.4 : unit == "cm" ? 10 : unit == "m" ? 1000 : 0;
  const PixelPitch pitch = {mm / x, mm / y};
  const bool is_one = x > 0 && y > 0 && mm > 0 && std::isfinite(pitch[0]) && std::isfinite(pitch[1]);
  return is_one ? pitch : PixelPitch();
}

std::uint32_t big_endian(const char* bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes[i]);
  return number;
}

/// The first four bytes of a chunk that stands before the pixels of a PNG, 0 where it has less; nothing where
/// there is no such chunk.
std::optional<std::uint32_t> png_chunk(const fs::path& file, std::string_view wanted) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(8);
  std::array<char, 12> head = {};
  while (in.read(head.data(), head.size())) {
    const std::string_view name(head.data() + 4, 4);
    const std::uint32_t bytes = big_endian(head.data());
    if (name == wanted) return bytes < 4 ? 0 : big_endian(head.data() + 8);
    if (name == "IDAT" || name == "IEND") break;
    in.seekg(std::streamoff{bytes}, std::ios::cur);
  }
  return std::nullopt;
}

ColorSpace color_of_png(const fs::path& file) {
  if (png_chunk(file, "sRGB")) return ColorSpace::kSrgb;
  const std::uint32_t encoding = png_chunk(file, "gAMA").value_or(0);  // of light, in 100000ths
  return encoding == 0 ? ColorSpace::kData : color_of_gamma(1e5 / encoding);
}

/// OpenImageIO takes every EXR for linear colour and every PNG for sRGB: here it counts what the file says.
ColorSpace color_of(const OIIO::ImageSpec& spec, const std::string& format, const fs::path& file) {
  if (format == "openexr") {
    return spec.find_attribute("chromaticities") != nullptr ? ColorSpace::kLinearColor : ColorSpace::kData;
  }
  if (const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile")) {
    const auto* bytes = static_cast<const std::uint8_t*>(profile->data());
    const ColorSpace color = color_of_profile({bytes, static_cast<std::size_t>(profile->datasize())});
    if (color != ColorSpace::kData) return color;
  }
  if (format == "jpeg") return ColorSpace::kSrgb;
  return format == "png" ? color_of_png(file) : ColorSpace::kData;
}

/// How often larger than its file the pixels of an EXR can be, with room above what a constant image gives.
double most_expansion(const OIIO::ImageSpec& spec) {
  const std::string compression = spec.get_string_attribute("compression");
  return compression == "none" ? 1 : compression.starts_with("dwa") ? 1e6 : 1e4;
}

struct OpenedImage {
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
  ImageFileInfo info;
};

Result<OpenedImage> open_image(const fs::path& file) {
  prepare_oiio();
  std::error_code failed;
  const std::uintmax_t file_bytes = fs::file_size(file, failed);
  if (failed) return cannot_read(file, failed.value());
  const Result<std::string> format = format_of(file);
  if (!format) return format.error();

  OpenedImage opened;
  opened.input = OIIO::ImageInput::create(*format);
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);
  const bool open = opened.input->open(file.string(), opened.spec, wishes);
  // Missing strips of a TIFF and the missing end of a JPEG are told by no return value, here and below.
  const std::string message = opened.input->geterror();
  if (!open || !message.empty()) return bad_data(file, oiio_reason(message));
  const OIIO::ImageSpec& spec = opened.spec;
  if (spec.deep || spec.depth > 1) return bad_data(file, "its pixels have depth");
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) return bad_data(file, "it has no pixels");
  if (spec.get_int_attribute("tiff:subfiletype") == 1) {
    return bad_data(file, "its first image is a thumbnail, as in a camera's raw file");
  }
  constexpr std::int64_t kLargeTile = std::int64_t{4096} * 4096;
  const std::int64_t tile = std::int64_t{spec.tile_width} * spec.tile_height;
  if (tile > std::max(kLargeTile, std::int64_t{spec.width} * spec.height)) {
    return bad_data(file, fmt::format("its tiles of {} x {} pixels are larger than the image",
                                      spec.tile_width, spec.tile_height));
  }
  const auto stored = static_cast<double>(spec.image_bytes(/*native=*/true));
  if (*format == "openexr" && stored > most_expansion(spec) * static_cast<double>(file_bytes)) {
    return bad_data(file,
                    fmt::format("its {} x {} pixels of {:.0f} bytes in all are more than its {} bytes hold",
                                spec.width, spec.height, stored, file_bytes));
  }
  opened.info = {{spec.width, spec.height},
                 {spec.channelnames.begin(), spec.channelnames.end()},
                 sample_type(spec),
                 *format,
                 attributes_of(spec, *format),
                 pitch_of(spec, *format),
                 color_of(spec, *format, file)};
  return opened;
}

/// Rows [y, y_end) of an opened image as interleaved floats. Returns why it failed, or nothing.
std::string read_rows(OpenedImage& opened, int y, int y_end, float* rows) {
  const OIIO::ImageSpec& spec = opened.spec;
  OIIO::ImageInput& input = *opened.input;
  const int y0 = spec.y + y, y1 = spec.y + y_end, channels = spec.nchannels;
  const bool read = spec.tile_width == 0
                        ? input.read_scanlines(0, 0, y0, y1, spec.z, 0, channels, OIIO::TypeFloat, rows)
                        : input.read_tiles(0, 0, spec.x, spec.x + spec.width, y0, y1, spec.z, spec.z + 1, 0,
                                           channels, OIIO::TypeFloat, rows);
  const std::string message = input.geterror();
  return read && message.empty() ? "" : oiio_reason(message);
}

/// Rows read at once: whole tiles, or enough lines to keep a decoder's threads busy.
int rows_a_band(const OIIO::ImageSpec& spec) {
  if (spec.tile_width > 0) return spec.tile_height;
  constexpr std::int64_t kBandBytes = std::int64_t{8} << 20;
  const std::int64_t row_bytes = std::int64_t{spec.width} * spec.nchannels * 4;
  return static_cast<int>(std::clamp<std::int64_t>(kBandBytes / row_bytes / 32 * 32, 32, 4096));
}

Result<LoadedImage> read_pixels(OpenedImage opened, const fs::path& file) {
  const Size size = opened.info.size;
  const int channels = opened.spec.nchannels;
  const int band_rows = std::min(rows_a_band(opened.spec), size.height);
  const double padded_width = static_cast<double>(detail::padded_stride(size.width));
  const double needed = 4.0 * channels * (padded_width * size.height + double{1} * size.width * band_rows);
  const double available = static_cast<double>(available_memory_bytes());
  if (needed > available) {
    return Error{ErrorKind::kTryAgain, "image does not fit into memory", file.string(),
                 fmt::format("{} x {} pixels with {} channels need {:.1f} GB, {:.1f} GB are free", size.width,
                             size.height, channels, needed * 1e-9, available * 1e-9),
                 "end other programs or use a larger machine"};
  }
  LoadedImage loaded{std::move(opened.info), Image<float>(size, channels)};
  std::vector<float> band(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(channels) *
                          static_cast<std::size_t>(band_rows));
  for (int y = 0; y < size.height; y += band_rows) {
    const int y_end = std::min(y + band_rows, size.height);
    if (const std::string why = read_rows(opened, y, y_end, band.data()); !why.empty()) {
      return bad_data(file, why);
    }
    for (int c = 0; c < channels; ++c) {
      const float* sample = band.data() + c;
      for (int row = y; row < y_end; ++row) {
        float* out = loaded.planes.plane(c).row(row);
        for (int x = 0; x < size.width; ++x, sample += channels) out[x] = *sample;
      }
    }
  }
  return loaded;
}

}  // namespace

View<const float> LoadedImage::channel(std::string_view name) const {
  const auto found = std::find(info.channels.begin(), info.channels.end(), name);
  if (found == info.channels.end()) return {};
  return planes.plane(static_cast<int>(found - info.channels.begin()));
}

Result<ImageFileInfo> read_image_info(const fs::path& file) try {
  Result<OpenedImage> opened = open_image(file);
  if (!opened) return opened.error();
  return std::move(opened->info);
} catch (const std::exception& damage) {
  return bad_data(file, damage.what());
}

Result<LoadedImage> read_image(const fs::path& file) try {
  Result<OpenedImage> opened = open_image(file);
  if (!opened) return opened.error();
  return read_pixels(*std::move(opened), file);
} catch (const std::exception& damage) {
  return bad_data(file, damage.what());
}

}  // namespace weft
