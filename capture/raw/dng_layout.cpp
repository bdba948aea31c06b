// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/dng_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "capture/raw/bayer.h"
#include "capture/raw/dng_opcodes.h"

namespace weft::capture {
namespace {

constexpr double kFullImage = 0, kMosaic = 32803, kUncompressed = 1, kLosslessJpeg = 7;
constexpr int kLongestSide = 65535;

enum Tag : std::uint16_t {
  kNewSubfileType = 254,
  kImageWidth = 256,
  kImageLength = 257,
  kBitsPerSample = 258,
  kCompression = 259,
  kPhotometricInterpretation = 262,
  kFillOrder = 266,
  kStripOffsets = 273,
  kSamplesPerPixel = 277,
  kRowsPerStrip = 278,
  kStripByteCounts = 279,
  kTileWidth = 322,
  kTileLength = 323,
  kTileOffsets = 324,
  kTileByteCounts = 325,
  kSampleFormat = 339,
  kCfaRepeatPatternDim = 33421,
  kCfaPattern = 33422,
  kCfaLayout = 50711,
  kLinearizationTable = 50712,
  kBlackLevelRepeatDim = 50713,
  kBlackLevel = 50714,
  kBlackLevelDeltaH = 50715,
  kBlackLevelDeltaV = 50716,
  kWhiteLevel = 50717,
  kActiveArea = 50829,
};

/// A run of bytes of the file: a strip or a tile.
struct Segment {
  std::uint64_t at = 0;
  std::uint64_t bytes = 0;
};

/// The samples in a lossless JPEG (ITU-T T.81: SOF3 and a first Huffman table, then SOS); nothing where
/// LibRaw would take the data for no such JPEG, and leave its counts as it found them in memory.
std::optional<std::int64_t> lossless_jpeg_samples(const Tiff& tiff, const Segment& segment) {
  constexpr std::uint8_t kHuffmanTable = 0xc4, kLosslessFrame = 0xc3, kScan = 0xda;
  constexpr int kMostMarkers = 64;
  std::array<std::uint8_t, 10> head;
  const auto word = [&head](std::size_t i) { return head[i] << 8 | head[i + 1]; };
  if (!tiff.read_at(segment.at, std::span(head).first(2)) || word(0) != 0xffd8) return {};
  std::uint64_t at = segment.at + 2;
  std::optional<std::int64_t> samples;
  bool has_table = false;
  for (int i = 0; i < kMostMarkers && at + head.size() <= segment.at + segment.bytes; ++i) {
    if (!tiff.read_at(at, head) || head[0] != 0xff) return {};
    if (head[1] == kScan) return has_table ? samples : std::nullopt;
    if (head[1] == kHuffmanTable && head[4] == 0) has_table = true;
    if (head[1] == kLosslessFrame && head[4] >= 2 && head[4] <= 16)
      samples = std::int64_t{word(5)} * word(7) * head[9];
    at += 2 + static_cast<std::uint64_t>(word(2));
  }
  return {};
}

/// Reads one raw directory, stopping at the first thing that is wrong.
class LayoutReader {
 public:
  LayoutReader(const Tiff& tiff, const TiffDirectory& directory, std::uint64_t file_bytes, std::string where)
      : tiff_(tiff), directory_(directory), file_bytes_(file_bytes), where_(std::move(where)) {}

  Result<DngLayout> read() {
    for (const auto step : {&LayoutReader::read_sizes, &LayoutReader::read_mosaic, &LayoutReader::read_data,
                            &LayoutReader::read_white, &LayoutReader::read_black})
      if (auto done = (this->*step)(); !done) return std::move(done).error();
    layout_.opcodes = opcodes_of(tiff_, directory_);
    return layout_;
  }

 private:
  Error refusal(std::string why, std::string remedy = "convert the camera's raw file to DNG again") const {
    return {ErrorKind::kBadData, "DNG is not one to be trusted", where_, std::move(why), std::move(remedy)};
  }
  double number(Tag tag, double otherwise) const {
    return tiff_.number(directory_, tag, otherwise).value_or(-1);
  }
  std::vector<double> numbers(Tag tag, std::vector<double> otherwise = {}) const {
    return Tiff::find(directory_, tag) == nullptr ? std::move(otherwise) : tiff_.numbers(directory_, tag);
  }

  Result<void> read_sizes() {
    const double width = number(kImageWidth, 0), height = number(kImageLength, 0);
    if (!(width >= 1 && width <= kLongestSide && height >= 1 && height <= kLongestSide))
      return refusal(fmt::format("its size is {} x {} pixels", width, height));
    layout_.stored = {static_cast<int>(width), static_cast<int>(height)};

    const std::vector<double> area = numbers(kActiveArea, {0, 0, height, width});
    if (area.size() != 4 || !(0 <= area[0] && area[0] < area[2] && area[2] <= height && 0 <= area[1] &&
                              area[1] < area[3] && area[3] <= width))
      return refusal(fmt::format("its active area does not lie within {} x {} pixels", width, height));
    const auto [top, left, bottom, right] = std::tie(area[0], area[1], area[2], area[3]);
    layout_.active = {static_cast<int>(left), static_cast<int>(top), static_cast<int>(right),
                      static_cast<int>(bottom)};
    return {};
  }

  Result<void> read_mosaic() {
    if (number(kSampleFormat, 1) != 1)
      return refusal("its counts are not unsigned integers", "convert without floating point or HDR");
    if (const double samples = number(kSamplesPerPixel, 1); samples != 1)
      return refusal(fmt::format("it has {} samples a pixel, a mosaic has 1", samples));
    const auto color = [](double code) { return code >= 0 && code <= 2 ? static_cast<int>(code) : -1; };
    const std::vector<double> c = numbers(kCfaPattern);
    std::optional<CfaPattern> cell;
    if (number(kCfaLayout, 1) == 1 && c.size() == 4 &&
        numbers(kCfaRepeatPatternDim) == std::vector<double>{2, 2})
      cell = bayer_cell({{{color(c[0]), color(c[1])}, {color(c[2]), color(c[3])}}});
    if (!cell) return not_bayer(where_);
    layout_.cfa = *cell;
    return {};
  }

  Result<void> read_data() {
    const TiffTag* const tiles = Tiff::find(directory_, kTileOffsets);
    const bool tiled = tiles != nullptr;
    const std::vector<double> offsets = numbers(tiled ? kTileOffsets : kStripOffsets);
    const std::vector<double> lengths = numbers(tiled ? kTileByteCounts : kStripByteCounts);
    if (offsets.empty() || offsets.size() != lengths.size())
      return refusal("it does not say where its data are");
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (!(offsets[i] > 0 && lengths[i] > 0)) return refusal("a piece of its data is empty");
      if (const double end = offsets[i] + lengths[i]; !(end <= static_cast<double>(file_bytes_)))
        return Error{ErrorKind::kBadData, "raw frame is truncated", where_,
                     fmt::format("{} bytes are missing of {}", end - static_cast<double>(file_bytes_), end),
                     "copy the file again"};
      segments.push_back({static_cast<std::uint64_t>(offsets[i]), static_cast<std::uint64_t>(lengths[i])});
    }
    layout_.data_at = tiled ? tiles->at : segments[0].at;

    const double compression = number(kCompression, kUncompressed);
    if (compression == kUncompressed) return check_uncompressed(std::move(segments), tiled);
    if (compression == kLosslessJpeg) return check_lossless_jpeg(segments, tiled);
    return refusal(fmt::format("its compression {} is not read", compression),
                   "convert to DNG uncompressed or with lossless JPEG");
  }

  /// The sides of a piece of the data.
  Size piece_size(bool tiled) const {
    const double width = tiled ? number(kTileWidth, 0) : layout_.stored.width;
    const double height = tiled
                              ? number(kTileLength, 0)
                              : std::min<double>(number(kRowsPerStrip, kLongestSide), layout_.stored.height);
    const bool is_possible = width >= 1 && width <= kLongestSide && height >= 1 && height <= kLongestSide;
    return is_possible ? Size{static_cast<int>(width), static_cast<int>(height)} : Size{};
  }

  /// Strips that follow one another are one, whatever they say of their rows.
  static void join(std::vector<Segment>& strips) {
    for (std::size_t i = 1; i < strips.size(); ++i)
      if (strips[i].at != strips[i - 1].at + strips[i - 1].bytes) return;
    strips = {{strips.front().at, strips.back().at + strips.back().bytes - strips.front().at}};
  }

  Result<void> check_uncompressed(std::vector<Segment> pieces, bool tiled) {
    const double bits = number(kBitsPerSample, 1);
    if (!(bits >= 8 && bits <= 16 && bits == std::floor(bits)))
      return refusal(fmt::format("its uncompressed counts have {} bits, not 8 to 16", bits));
    if (number(kFillOrder, 1) != 1) return refusal("the bits of its bytes are in reverse order");
    if (!tiled) join(pieces);
    const auto [width, height] = layout_.stored;
    Size piece = pieces.size() == 1 && !tiled ? layout_.stored : piece_size(tiled);
    if (piece.pixels() == 0) return refusal("its strips or tiles have no size");
    const int columns = (width + piece.width - 1) / piece.width;
    const int rows = (height + piece.height - 1) / piece.height;
    if (std::cmp_not_equal(pieces.size(), std::int64_t{columns} * rows))
      return refusal(
          fmt::format("it has {} strips or tiles, not {}", pieces.size(), std::int64_t{columns} * rows));
    const std::uint64_t row_bytes =
        (static_cast<std::uint64_t>(piece.width) * static_cast<unsigned>(bits) + 7) / 8;
    PlainCounts plain = {piece, {}, static_cast<int>(bits), tiff_.is_big_endian(), {}};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const int top = static_cast<int>(i) / columns * piece.height;
      const int lines = tiled ? piece.height : std::min(piece.height, height - top);
      if (pieces[i].bytes != row_bytes * static_cast<unsigned>(lines))
        return refusal(fmt::format("its {} x {} counts of {} bits take {} bytes, it holds {}", piece.width,
                                   lines, bits, row_bytes * static_cast<unsigned>(lines), pieces[i].bytes));
      plain.at.push_back(pieces[i].at);
    }
    for (const double value : numbers(kLinearizationTable))
      plain.table.push_back(static_cast<std::uint16_t>(std::clamp(value, 0.0, 65535.0)));
    layout_.plain = std::move(plain);
    return {};
  }

  Result<void> check_lossless_jpeg(const std::vector<Segment>& segments, bool tiled) {
    const Size size = layout_.stored;
    double width = size.width, height = size.height, expected = 1;
    if (tiled) {
      const Size tile = piece_size(tiled);
      if (tile.pixels() == 0) return refusal("its tiles have no size");
      width = tile.width, height = tile.height;
      expected = std::ceil(size.width / width) * std::ceil(size.height / height);
      if (expected == 1) return refusal("it is one tile", "convert to DNG with strips or smaller tiles");
    }
    if (static_cast<double>(segments.size()) != expected)
      return refusal(fmt::format("it has {} lossless JPEGs, not {}", segments.size(), expected));
    for (const Segment& segment : segments)
      if (const auto samples = lossless_jpeg_samples(tiff_, segment);
          !samples || static_cast<double>(*samples) != width * height)
        return refusal(fmt::format("its data at byte {} are no lossless JPEG of {} x {} counts", segment.at,
                                   width, height));
    return {};
  }

  /// What the largest code of so many bits stands for, where nothing is said.
  double largest_count() const {
    const double code = std::exp2(number(kBitsPerSample, 1)) - 1;
    const std::vector<double> table = numbers(kLinearizationTable);
    if (table.empty()) return code;
    return table[std::min(table.size() - 1, static_cast<std::size_t>(std::max(0.0, code)))];
  }

  Result<void> read_white() {
    const double white = number(kWhiteLevel, largest_count());
    if (!(white > 0 && white <= 65535)) return refusal(fmt::format("its white level is {} counts", white));
    layout_.white = static_cast<float>(white);
    return {};
  }

  /// Differences along one side of the active area; empty where there are none.
  Result<std::vector<double>> deltas(Tag tag, int length) const {
    std::vector<double> found = numbers(tag, {0});
    if (found.empty()) return refusal("its black level's changes along rows or columns cannot be read");
    if (found == std::vector<double>(found.size())) return std::vector<double>();
    if (std::cmp_not_equal(found.size(), length))
      return refusal(
          fmt::format("its black level changes along {} rows or columns, it has {}", found.size(), length));
    return found;
  }

  Result<void> read_black() {
    const std::vector<double> repeat = numbers(kBlackLevelRepeatDim, {1, 1});
    const bool is_said = Tiff::find(directory_, kBlackLevel) != nullptr;
    const std::vector<double> black = is_said ? numbers(kBlackLevel) : std::vector<double>{0};
    if (black.empty()) return refusal("its black level cannot be read");
    const bool is_pattern = repeat.size() == 2 && repeat[0] >= 1 && repeat[1] >= 1;
    if (is_said && !(is_pattern && static_cast<double>(black.size()) == repeat[0] * repeat[1]))
      return refusal(fmt::format("its {} black levels are no pattern", black.size()));
    Result<std::vector<double>> by_column = deltas(kBlackLevelDeltaH, layout_.active.width());
    if (!by_column) return std::move(by_column).error();
    Result<std::vector<double>> by_row = deltas(kBlackLevelDeltaV, layout_.active.height());
    if (!by_row) return std::move(by_row).error();
    const std::size_t columns = is_said ? static_cast<std::size_t>(repeat[1]) : 1;
    layout_.black = DngBlack(black, columns, *std::move(by_column), *std::move(by_row));
    for (const auto& row : layout_.black.cell())
      for (const float level : row)
        if (!(level >= 0 && level < layout_.white))
          return refusal(
              fmt::format("its black level is {} counts and its white level {}", level, layout_.white));
    return {};
  }

  const Tiff& tiff_;
  const TiffDirectory& directory_;
  std::uint64_t file_bytes_;
  std::string where_;
  DngLayout layout_;
};

}  // namespace

Result<DngLayout> read_dng_layout(const Tiff& tiff, std::uint64_t file_bytes, const std::string& where) {
  const auto is_full_mosaic = [&tiff](const TiffDirectory& directory) {
    return tiff.number(directory, kPhotometricInterpretation) == kMosaic &&
           tiff.number(directory, kNewSubfileType, kFullImage) == kFullImage;
  };
  const auto& all = tiff.directories();
  const auto raw = std::find_if(all.begin(), all.end(), is_full_mosaic);
  if (const auto count = std::count_if(all.begin(), all.end(), is_full_mosaic); count != 1)
    return Error{ErrorKind::kBadData, "DNG does not hold one mosaic", where,
                 fmt::format("it holds {} full-size colour filter arrays", count),
                 "convert the camera's raw file without demosaicing"};
  return LayoutReader(tiff, *raw, file_bytes, where).read();
}

}  // namespace weft::capture
