// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/decode_raw.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <utility>

#include "capture/raw/opened_raw.h"
#include "capture/raw/plain_counts.h"

namespace weft::capture {
namespace {

/// What a decoder may ask for beyond its last code, in bytes: bits are read some words ahead.
constexpr std::uint64_t kReadAhead = 16;

std::string words(const Size& size) {
  return fmt::format("{} x {} pixels", size.width, size.height);
}
std::string words(const std::string& model) {
  return model;
}
std::string words(const CfaPattern& cfa) {
  constexpr char kLetters[] = "RGBG";
  std::string letters;
  for (const auto& row : cfa.site)
    for (const std::uint8_t site : row) letters += site < 4 ? kLetters[site] : '?';
  return letters;
}

template <typename T>
Result<void> check(const char* what, const std::optional<T>& expected, const T& found,
                   const std::string& where) {
  if (!expected || *expected == found) return {};
  return Error{ErrorKind::kBadData, fmt::format("raw frame has another {}", what), where,
               fmt::format("expected {}, found {}", words(*expected), words(found)),
               "use frames of one camera with one setting"};
}

using Cell = std::array<std::array<float, 2>, 2>;

/// Black of the 2 x 2 cell as LibRaw knows it: a level, one a colour, and a pattern on the active area.
Result<Cell> black_levels(LibRaw& libraw, const std::string& where) {
  const libraw_colordata_t& color = libraw.imgdata.color;
  const std::uint64_t pattern_sites = std::uint64_t{color.cblack[4]} * color.cblack[5];
  const unsigned rows = pattern_sites == 0 ? 1 : color.cblack[4];
  const unsigned columns = pattern_sites == 0 ? 1 : color.cblack[5];
  const auto black_at = [&](unsigned x, unsigned y) {
    const unsigned pattern = pattern_sites == 0 ? 0 : color.cblack[6 + y % rows * columns + x % columns];
    const int site = libraw.COLOR(static_cast<int>(y % 2), static_cast<int>(x % 2));
    return float(color.black + color.cblack[site] + pattern);
  };
  if (pattern_sites > LIBRAW_CBLACK_SIZE - 6) return distrust("its black levels have no end", where);
  Cell black = {};
  for (unsigned y = 0; y < 2 * rows; ++y)
    for (unsigned x = 0; x < 2 * columns; ++x) {
      if (black_at(x, y) != black_at(x % 2, y % 2))
        return distrust(
            fmt::format("its black levels repeat every {} x {} photosites, not 2 x 2", columns, rows), where);
      black[y % 2][x % 2] = black_at(x, y);
    }
  return black;
}

/// Sets black and white: a DNG's own, which may have fractions; of other files those of LibRaw.
Result<void> set_levels(RawFrame& frame, const OpenedRaw& raw, const std::string& where) {
  if (raw.dng) {
    frame.black = raw.dng->black.cell();
    frame.white = raw.dng->white;
    return {};
  }
  const auto black = black_levels(*raw.libraw, where);
  if (!black) return black.error();
  frame.black = *black;
  frame.white = float(raw.libraw->imgdata.color.maximum);
  for (const auto& row : frame.black)
    for (const float level : row)
      if (!(level < frame.white && frame.white <= 65535))
        return distrust(
            fmt::format("its black level is {} counts and its white level {}", level, frame.white), where);
  return {};
}

Error truncated(const std::string& where) {
  return {ErrorKind::kBadData, "raw frame is truncated", where, "the file ends before its data do",
          "copy the file again"};
}

/// LibRaw unpacks the counts, all of which must be there.
Result<void> unpack(OpenedRaw& raw, const std::string& where) {
  raw.file->missing_bytes = 0;
  const int code = raw.libraw->unpack();
  if (code == LIBRAW_UNSUFFICIENT_MEMORY) return out_of_memory(where);
  const bool failed = code != LIBRAW_SUCCESS || raw.libraw->error_count() != 0;
  if (raw.file->missing_bytes > (failed ? 0 : kReadAhead)) return truncated(where);
  if (failed)
    return Error{ErrorKind::kBadData, "raw frame cannot be decoded", where,
                 fmt::format("its data are damaged, or packed in a way that LibRaw {} does not read",
                             LibRaw::version()),
                 "copy the file again, or convert it to DNG"};
  return {};
}

Result<void> read_by_libraw(OpenedRaw& raw, const std::string& where, View<std::uint16_t> out) {
  if (auto done = unpack(raw, where); !done) return std::move(done).error();
  const libraw_rawdata_t& unpacked = raw.libraw->imgdata.rawdata;
  const Rect& active = raw.active;
  if (unpacked.raw_image == nullptr || active.x1 > unpacked.sizes.raw_width ||
      active.y1 > unpacked.sizes.raw_height)
    return distrust("LibRaw unpacks it to something other than a mosaic", where);
  const std::size_t stride = unpacked.sizes.raw_pitch / sizeof(std::uint16_t);
  for (int y = active.y0; y < active.y1; ++y) {
    const std::uint16_t* const row = unpacked.raw_image + static_cast<std::size_t>(y) * stride;
    std::copy(row + active.x0, row + active.x1, out.row(y - active.y0));
  }
  return {};
}

Result<void> read_counts(OpenedRaw& raw, const std::string& where, View<std::uint16_t> out) {
  if (!raw.dng || !raw.dng->plain) return read_by_libraw(raw, where, out);
  const auto read_at = [&raw](std::uint64_t offset, std::span<std::uint8_t> bytes) {
    return raw.file->seek(static_cast<INT64>(offset), SEEK_SET) == 0 &&
           raw.file->read(bytes.data(), 1, bytes.size()) == static_cast<int>(bytes.size());
  };
  const DngLayout& dng = *raw.dng;
  return read_plain_counts(*dng.plain, dng.stored, dng.active, read_at, out) ? Result<void>()
                                                                             : truncated(where);
}

}  // namespace

Result<RawFrame> decode_raw(const std::filesystem::path& file, const DecodeExpectation& expected) {
  const std::string where = file.string();
  auto raw = open_raw(file);
  if (!raw) return std::move(raw).error();
  RawInfo& info = raw->info;
  if (auto same = check("size", expected.size, info.size, where); !same) return std::move(same).error();
  if (auto same = check("filter cell", expected.cfa, info.cfa, where); !same) return std::move(same).error();
  if (auto same = check("camera model", expected.model, info.shot.model, where); !same)
    return std::move(same).error();

  RawFrame frame = {Image<std::uint16_t>(info.size), info.cfa, {}, 0, std::move(info.shot)};
  if (auto read = read_counts(*raw, where, frame.counts.plane()); !read) return std::move(read).error();
  if (auto set = set_levels(frame, *raw, where); !set) return std::move(set).error();
  if (raw->dng) raw->dng->black.level(frame.counts.plane(), frame.white);
  return frame;
}

}  // namespace weft::capture
