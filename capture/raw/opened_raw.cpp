// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/opened_raw.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include "capture/raw/bayer.h"
#include "capture/raw/tiff_tags.h"
#include "core/base/files.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

constexpr char kUseRaw[] = "set the camera to raw only and copy its raw files";
constexpr unsigned kMostDecodedMegabytes = 1024;
constexpr std::uint16_t kMake = 271, kModel = 272, kDngVersion = 50706, kUniqueCameraModel = 50708;
constexpr std::size_t kLongestName = 63;

/// A file open for reading.
class InputFile {
 public:
  explicit InputFile(const fs::path& file)
      : descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  bool is_open() const { return descriptor_ >= 0; }

  /// Nothing where it is no regular file.
  std::optional<std::uint64_t> bytes() const {
    struct stat status = {};
    if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) return {};
    return static_cast<std::uint64_t>(status.st_size);
  }

  bool read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const {
    while (!bytes.empty()) {
      const ssize_t got = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(got));
      offset += static_cast<std::uint64_t>(got);
    }
    return true;
  }

 private:
  int descriptor_;
};

/// A text field of fixed size from a file: other than printable ASCII becomes '?'.
template <std::size_t N>
std::string text_of(const char (&field)[N]) {
  std::string text(field, strnlen(field, N));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

double finite_positive(float value) {
  return std::isfinite(value) && value > 0 ? double{value} : 0;
}

// LibRaw keeps f/5.6 as a float, 5.599999904632568.
double to_hundredths(double value) {
  return std::round(100 * value) / 100;
}

ShotMetadata shot_of(const libraw_data_t& data) {
  return {.make = text_of(data.idata.make),
          .model = text_of(data.idata.model),
          .serial = text_of(data.shootinginfo.BodySerial),
          .exposure_us = 1e6 * finite_positive(data.other.shutter),
          .iso = finite_positive(data.other.iso_speed),
          .f_number = to_hundredths(finite_positive(data.other.aperture)),
          .focal_mm = to_hundredths(finite_positive(data.other.focal_len))};
}

/// The filter cell by LibRaw, at its visible area's (0, 0). Eight rows of two columns are the period of its
/// code.
std::optional<CfaPattern> libraw_cell(LibRaw& libraw) {
  const libraw_iparams_t& image = libraw.imgdata.idata;
  if (image.filters < 1000 || image.colors != 3 || std::string_view(image.cdesc) != "RGBG" ||
      libraw.is_fuji_rotated())
    return {};
  const auto channel = [&libraw](int x, int y) {
    const int color = libraw.COLOR(y, x);
    return color == 3 ? 1 : color;
  };
  const auto cell = bayer_cell({{{channel(0, 0), channel(1, 0)}, {channel(0, 1), channel(1, 1)}}});
  for (int y = 2; cell && y < 8; ++y)
    if (channel(0, y) != cell->channel_at(0, y) || channel(1, y) != cell->channel_at(1, y)) return {};
  return cell;
}

Error open_error(int code, const std::string& where) {
  if (code == LIBRAW_UNSUFFICIENT_MEMORY) return out_of_memory(where);
  return {ErrorKind::kBadData, "not a raw frame", where,
          fmt::format("LibRaw says: {}", libraw_strerror(code)), kUseRaw};
}

/// LibRaw 0.20 reads and copies camera names without regard to their length, and aborts over some that have
/// no end. So a TIFF reaches it only with names that end, fit its fields and can be printed.
Result<void> check_names(const Tiff& tiff, const std::string& where) {
  for (const TiffDirectory& directory : tiff.directories())
    for (const std::uint16_t tag : {kMake, kModel, kUniqueCameraModel}) {
      if (Tiff::find(directory, tag) == nullptr) continue;
      const auto name = tiff.text(directory, tag);
      if (!name || name->size() > kLongestName) return distrust("the name of its camera is damaged", where);
    }
  return {};
}

/// A DNG is described by its own tags; LibRaw must only agree on which counts it is about to unpack.
Result<void> describe_dng(OpenedRaw& raw, const std::string& where) {
  const DngLayout& layout = *raw.dng;
  const libraw_image_sizes_t& sizes = raw.libraw->imgdata.sizes;
  if (layout.stored != Size{sizes.raw_width, sizes.raw_height})
    return distrust(fmt::format("its tags say {} x {} counts, LibRaw {} x {}", layout.stored.width,
                                layout.stored.height, sizes.raw_width, sizes.raw_height),
                    where);
  const auto data_at = raw.libraw->get_internal_data_pointer()->unpacker_data.data_offset;
  if (!layout.plain && std::cmp_not_equal(layout.data_at, data_at))
    return distrust(fmt::format("its tags put the data at byte {}, LibRaw at {}", layout.data_at, data_at),
                    where);
  raw.info.cfa = layout.cfa;
  raw.info.opcodes = layout.opcodes;
  raw.active = layout.active;
  return {};
}

/// A vendor's file is described by LibRaw, if LibRaw knows the camera.
Result<void> describe_vendor_raw(OpenedRaw& raw, const std::string& where) {
  LibRaw& libraw = *raw.libraw;
  const std::optional<CfaPattern> cell = libraw_cell(libraw);
  if (!cell) return not_bayer(where);
  if (libraw.imgdata.color.cam_xyz[0][0] == 0)
    return distrust("LibRaw does not know this camera, and would guess its black and white levels", where);
  if (libraw.is_floating_point()) return distrust("its counts are floating-point numbers", where);
  const libraw_image_sizes_t& sizes = libraw.imgdata.sizes;
  raw.info.cfa = *cell;
  raw.active = {sizes.left_margin, sizes.top_margin, sizes.left_margin + sizes.width,
                sizes.top_margin + sizes.height};
  if (raw.active.pixels() == 0 || raw.active.x1 > sizes.raw_width || raw.active.y1 > sizes.raw_height)
    return distrust(fmt::format("its {} x {} pixels do not lie on its sensor of {} x {}", sizes.width,
                                sizes.height, sizes.raw_width, sizes.raw_height),
                    where);
  return {};
}

}  // namespace

int CountedFile::read(void* to, std::size_t size, std::size_t count) {
  const auto wanted = static_cast<std::streamsize>(size * count);
  const std::streamsize got = f->sgetn(static_cast<char*>(to), wanted);
  missing_bytes += static_cast<std::uint64_t>(wanted - got);
  return size == 0 ? 0 : static_cast<int>(static_cast<std::size_t>(got) / size);
}

int CountedFile::get_char() {
  const int byte = LibRaw_file_datastream::get_char();
  missing_bytes += byte < 0;
  return byte;
}

Error out_of_memory(const std::string& where) {
  return {ErrorKind::kTryAgain, "raw frame cannot be decoded", where, "there is not enough memory",
          "close other programs and run it again"};
}

Error distrust(std::string why, const std::string& where) {
  return {ErrorKind::kBadData, "raw frame is not one to be trusted", where, std::move(why),
          "use the camera's raw file as it is, or convert it to DNG"};
}

Result<OpenedRaw> open_raw(const fs::path& file) {
  const std::string where = file.string();
  const InputFile input(file);
  if (!input.is_open()) return cannot_read(file, errno);
  const std::optional<std::uint64_t> bytes = input.bytes();
  if (!bytes) return Error{ErrorKind::kNoInput, "cannot read", where, "it is no file", "name a raw file"};
  if (*bytes == 0)
    return Error{ErrorKind::kBadData, "raw frame is empty", where, "the file has 0 bytes",
                 "copy the file again"};
  std::array<std::uint8_t, 3> magic = {};
  if (input.read_at(0, magic) && magic == std::array<std::uint8_t, 3>{0xff, 0xd8, 0xff})
    return Error{ErrorKind::kBadData, "a JPEG is not a raw frame", where,
                 "its readings went through the camera's tone curve", kUseRaw};

  OpenedRaw raw;
  if (const auto tiff = Tiff::read([&input](auto at, auto span) { return input.read_at(at, span); })) {
    if (auto checked = check_names(*tiff, where); !checked) return std::move(checked).error();
    if (Tiff::find(tiff->directories()[0], kDngVersion) != nullptr) {
      auto layout = read_dng_layout(*tiff, *bytes, where);
      if (!layout) return std::move(layout).error();
      raw.dng = *layout;
    }
  }
  raw.file = std::make_unique<CountedFile>(file.c_str());
  raw.libraw = std::make_unique<LibRaw>(LIBRAW_OPIONS_NO_MEMERR_CALLBACK | LIBRAW_OPIONS_NO_DATAERR_CALLBACK);
  libraw_data_t& data = raw.libraw->imgdata;
  data.params.max_raw_memory_mb = kMostDecodedMegabytes;
  if (const int code = raw.libraw->open_datastream(raw.file.get()); code != LIBRAW_SUCCESS)
    return open_error(code, where);
  if (data.idata.raw_count != 1)
    return distrust(fmt::format("it holds {} frames", data.idata.raw_count), where);
  if (raw.dng.has_value() != (data.idata.dng_version != 0))
    return distrust("LibRaw and its own tags do not agree whether it is a DNG", where);
  auto described = raw.dng ? describe_dng(raw, where) : describe_vendor_raw(raw, where);
  if (!described) return std::move(described).error();
  raw.info.size = {raw.active.width(), raw.active.height()};
  raw.info.shot = shot_of(data);
  return raw;
}

}  // namespace weft::capture
