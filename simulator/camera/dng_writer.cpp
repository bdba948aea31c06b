// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/dng_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/files.h"

namespace weft::simulator {
namespace {

static_assert(std::endian::native == std::endian::little,
              "values and counts are stored as they lie in memory");

constexpr std::uint32_t kHeaderBytes = 8;
constexpr std::uint64_t kStripAlignment = 16;
constexpr int kLongestSide = 65535;
// Room is left for the head, which is under 1 kB with texts as long as LibRaw reads them.
constexpr std::uint64_t kLargestStrip = (std::uint64_t{1} << 32) - (std::uint64_t{1} << 16);
constexpr std::size_t kLongestText = 63;
constexpr std::size_t kDateLength = 19;

enum class Type : std::uint16_t {
  kByte = 1,
  kAscii = 2,
  kShort = 3,
  kLong = 4,
  kRational = 5,
  kUndefined = 7,
  kSRational = 10
};

enum Tag : std::uint16_t {
  kNewSubfileType = 254,
  kImageWidth = 256,
  kImageLength = 257,
  kBitsPerSample = 258,
  kCompression = 259,
  kPhotometricInterpretation = 262,
  kMake = 271,
  kModel = 272,
  kStripOffsets = 273,
  kOrientation = 274,
  kSamplesPerPixel = 277,
  kRowsPerStrip = 278,
  kStripByteCounts = 279,
  kPlanarConfiguration = 284,
  kCfaRepeatPatternDim = 33421,
  kCfaPattern = 33422,
  kExposureTime = 33434,
  kFNumber = 33437,
  kExifDirectory = 34665,
  kIsoSpeed = 34855,
  kExifVersion = 36864,
  kDateTimeOriginal = 36867,
  kFocalLength = 37386,
  kImageNumber = 37393,  // of TIFF/EP (ISO 12234-2), where readers look for it among the EXIF tags
  kSubSecTimeOriginal = 37521,
  kDngVersion = 50706,
  kDngBackwardVersion = 50707,
  kUniqueCameraModel = 50708,
  kBlackLevelRepeatDim = 50713,
  kBlackLevel = 50714,
  kWhiteLevel = 50717,
  kColorMatrix1 = 50721,
  kAsShotNeutral = 50728,
  kCameraSerialNumber = 50735,
  kCalibrationIlluminant1 = 50778,
};

constexpr std::uint16_t kNoCompression = 1, kColorFilterArray = 32803, kUpright = 1, kD65 = 21;

struct Entry {
  std::uint16_t tag;
  Type type;
  std::uint32_t count;
  std::string value;
};
using Directory = std::vector<Entry>;  // in rising order of tag, as TIFF demands

template <typename T>
void append(std::string& bytes, T number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// The simplest p / q within 1e-9 of `value` (relative), by continued fraction (Hardy & Wright, chapter 10).
std::pair<std::int32_t, std::int32_t> nearest_ratio(double value) {
  constexpr double kLargest = std::numeric_limits<std::int32_t>::max();
  double p = std::floor(value), q = 1, p_before = 1, q_before = 0, rest = value - p;
  while (std::abs(p / q - value) > 1e-9 * value && rest > 0) {
    const double term = std::floor(1 / rest);
    rest = 1 / rest - term;
    const double p_next = term * p + p_before, q_next = term * q + q_before;
    if (p_next > kLargest || q_next > kLargest) break;
    p_before = std::exchange(p, p_next);
    q_before = std::exchange(q, q_next);
  }
  return {static_cast<std::int32_t>(p), static_cast<std::int32_t>(q)};
}

template <typename T>
Entry numbers(std::uint16_t tag, Type type, std::initializer_list<T> values) {
  Entry entry{tag, type, static_cast<std::uint32_t>(values.size()), {}};
  for (const T value : values) append(entry.value, value);
  return entry;
}
Entry bytes(std::uint16_t tag, std::initializer_list<std::uint8_t> v) {
  return numbers(tag, Type::kByte, v);
}
Entry shorts(std::uint16_t tag, std::initializer_list<std::uint16_t> v) {
  return numbers(tag, Type::kShort, v);
}
Entry longs(std::uint16_t tag, std::initializer_list<std::uint32_t> v) {
  return numbers(tag, Type::kLong, v);
}

Entry ascii(std::uint16_t tag, const std::string& text) {
  return {tag, Type::kAscii, static_cast<std::uint32_t>(text.size() + 1), text + '\0'};
}

Entry rationals(std::uint16_t tag, Type type, std::span<const double> values) {
  Entry entry{tag, type, static_cast<std::uint32_t>(values.size()), {}};
  for (const double value : values) {
    const auto [p, q] = nearest_ratio(std::abs(value));
    append(entry.value, value < 0 ? -p : p);
    append(entry.value, q);
  }
  return entry;
}
Entry rational(std::uint16_t tag, double value) {
  return rationals(tag, Type::kRational, {&value, 1});
}

std::size_t padded(std::size_t bytes) {
  return bytes + bytes % 2;
}

std::size_t bytes_of(const Directory& directory) {
  std::size_t total = 2 + 12 * directory.size() + 4;
  for (const Entry& e : directory)
    if (e.value.size() > 4) total += padded(e.value.size());
  return total;
}

/// Appends a directory and behind it the values that do not fit into their entries.
void append(std::string& file, const Directory& directory) {
  std::size_t values_at = file.size() + 2 + 12 * directory.size() + 4;
  std::string values;
  append(file, static_cast<std::uint16_t>(directory.size()));
  for (const Entry& e : directory) {
    append(file, e.tag);
    append(file, static_cast<std::uint16_t>(e.type));
    append(file, e.count);
    std::string field = e.value;
    if (field.size() > 4) {
      values += field;
      values.resize(padded(values.size()));
      field.clear();
      append(field, static_cast<std::uint32_t>(values_at));
      values_at += padded(e.value.size());
    }
    field.resize(4);
    file += field;
  }
  append(file, std::uint32_t{0});
  file += values;
}

Directory exif_directory(const ShotMetadata& shot, const DngTags& tags) {
  Directory exif;
  if (shot.exposure_us > 0) exif.push_back(rational(kExposureTime, shot.exposure_us * 1e-6));
  if (shot.f_number > 0) exif.push_back(rational(kFNumber, shot.f_number));
  if (shot.iso > 0) exif.push_back(shorts(kIsoSpeed, {static_cast<std::uint16_t>(std::lround(shot.iso))}));
  exif.push_back({kExifVersion, Type::kUndefined, 4, "0230"});
  if (!tags.date_time_original.empty()) exif.push_back(ascii(kDateTimeOriginal, tags.date_time_original));
  if (shot.focal_mm > 0) exif.push_back(rational(kFocalLength, shot.focal_mm));
  if (tags.image_number) exif.push_back(longs(kImageNumber, {*tags.image_number}));
  if (tags.milliseconds) {
    exif.push_back(ascii(kSubSecTimeOriginal, fmt::format("{:03}", *tags.milliseconds)));
  }
  return exif;
}

std::uint64_t strip_bytes(Size size) {
  return 2 * static_cast<std::uint64_t>(size.pixels());
}

Directory raw_directory(const RawFrame& frame, Size size, const DngTags& tags, std::uint32_t exif_at,
                        std::uint32_t strip_at) {
  const auto width = static_cast<std::uint32_t>(size.width);
  const auto height = static_cast<std::uint32_t>(size.height);
  const ShotMetadata& shot = frame.shot;
  const auto color = [&frame](int x, int y) { return static_cast<std::uint8_t>(frame.cfa.channel_at(x, y)); };
  std::vector<double> black = {frame.black[0][0], frame.black[0][1], frame.black[1][0], frame.black[1][1]};
  if (black == std::vector(4, black[0])) black.resize(1);
  const auto black_side = static_cast<std::uint16_t>(black.size() == 1 ? 1 : 2);

  Directory raw = {
      longs(kNewSubfileType, {0}),
      longs(kImageWidth, {width}),
      longs(kImageLength, {height}),
      shorts(kBitsPerSample, {16}),
      shorts(kCompression, {kNoCompression}),
      shorts(kPhotometricInterpretation, {kColorFilterArray}),
      ascii(kMake, shot.make),
      ascii(kModel, shot.model),
      longs(kStripOffsets, {strip_at}),
      shorts(kOrientation, {kUpright}),
      shorts(kSamplesPerPixel, {1}),
      longs(kRowsPerStrip, {height}),
      longs(kStripByteCounts, {static_cast<std::uint32_t>(strip_bytes(size))}),
      shorts(kPlanarConfiguration, {1}),
      shorts(kCfaRepeatPatternDim, {2, 2}),
      bytes(kCfaPattern, {color(0, 0), color(1, 0), color(0, 1), color(1, 1)}),
      longs(kExifDirectory, {exif_at}),
      bytes(kDngVersion, {1, 4, 0, 0}),
      bytes(kDngBackwardVersion, {1, 1, 0, 0}),
      ascii(kUniqueCameraModel, shot.make + ' ' + shot.model),
      shorts(kBlackLevelRepeatDim, {black_side, black_side}),
      rationals(kBlackLevel, Type::kRational, black),
      longs(kWhiteLevel, {static_cast<std::uint32_t>(frame.white)}),
      rationals(kColorMatrix1, Type::kSRational, tags.camera_from_xyz),
      rationals(kAsShotNeutral, Type::kRational, tags.as_shot_neutral),
  };
  if (!shot.serial.empty()) raw.push_back(ascii(kCameraSerialNumber, shot.serial));
  raw.push_back(shorts(kCalibrationIlluminant1, {kD65}));
  return raw;
}

/// Everything before the counts.
std::string dng_head(const RawFrame& frame, Size size, const DngTags& tags) {
  const Directory exif = exif_directory(frame.shot, tags);
  const std::size_t exif_at = kHeaderBytes + bytes_of(raw_directory(frame, size, tags, 0, 0));
  const std::size_t strip_at =
      (exif_at + bytes_of(exif) + kStripAlignment - 1) / kStripAlignment * kStripAlignment;

  std::string head = "II*";
  head.resize(4);
  append(head, kHeaderBytes);
  append(head, raw_directory(frame, size, tags, static_cast<std::uint32_t>(exif_at),
                             static_cast<std::uint32_t>(strip_at)));
  append(head, exif);
  head.resize(strip_at);
  return head;
}

/// The four Bayer cells are one cell moved by a column, a row or both.
bool is_bayer(const CfaPattern& cfa) {
  const CfaPattern rggb;
  for (const int dy : {0, 1})
    for (const int dx : {0, 1})
      if (cfa.site_at(0, 0) == rggb.site_at(dx, dy) && cfa.site_at(1, 0) == rggb.site_at(dx + 1, dy) &&
          cfa.site_at(0, 1) == rggb.site_at(dx, dy + 1) && cfa.site_at(1, 1) == rggb.site_at(dx + 1, dy + 1))
        return true;
  return false;
}

/// Why this frame cannot be a DNG; empty when it can.
std::string fault_of(const RawFrame& frame, Size size, const DngTags& tags) {
  if (size.width < 1 || size.height < 1) return "it is no mosaic of one plane with pixels";
  if (size.width > kLongestSide || size.height > kLongestSide)
    return fmt::format("one of its sides of {} and {} pixels is over {}", size.width, size.height,
                       kLongestSide);
  if (strip_bytes(size) > kLargestStrip)
    return fmt::format("{} x {} pixels do not fit into 4 GiB", size.width, size.height);
  if (!is_bayer(frame.cfa)) return "its filter cell is not a Bayer cell";
  if (!(frame.white >= 1 && frame.white <= 65535 && frame.white == std::floor(frame.white)))
    return fmt::format("its white level {} is not a whole number of 1 to 65535 counts", frame.white);
  for (const auto& row : frame.black)
    for (const float black : row)
      if (!(black >= 0 && black < frame.white))
        return fmt::format("its black level {} is not between 0 and its white level {}", black, frame.white);

  const auto is_printable = [](char c) { return c >= ' ' && c <= '~'; };
  const auto& [make, model, serial, exposure_us, iso, f_number, focal_mm] = frame.shot;
  if (make.empty() || model.empty()) return "it does not name the make and model of its camera";
  for (const std::string& text : {make + ' ' + model, serial})
    if (text.size() > kLongestText || !std::all_of(text.begin(), text.end(), is_printable))
      return fmt::format("\"{}\" is no text of up to {} ASCII characters", text, kLongestText);
  if (!(exposure_us == 0 || (exposure_us >= 1e-3 && exposure_us <= 1e9)))
    return fmt::format("its exposure of {} us is not between 1 ns and 1000 s", exposure_us);
  if (!(iso >= 0 && iso <= 65535)) return fmt::format("its ISO {} is not between 0 and 65535", iso);
  if (!(f_number >= 0 && f_number <= 1000))
    return fmt::format("its f-number {} is not between 0 and 1000", f_number);
  if (!(focal_mm >= 0 && focal_mm <= 10000))
    return fmt::format("its focal length of {} mm is not between 0 and 10 m", focal_mm);
  const auto& date = tags.date_time_original;
  if (!date.empty() && (date.size() != kDateLength || !std::all_of(date.begin(), date.end(), is_printable)))
    return fmt::format("its date \"{}\" is not as EXIF has it", date);
  if (const int milliseconds = tags.milliseconds.value_or(0); milliseconds < 0 || milliseconds > 999)
    return fmt::format("its {} milliseconds are not between 0 and 999", milliseconds);
  const auto in_range = [](double value) { return std::abs(value) <= 1000; };
  if (!std::all_of(tags.as_shot_neutral.begin(), tags.as_shot_neutral.end(), in_range) ||
      !std::all_of(tags.camera_from_xyz.begin(), tags.camera_from_xyz.end(), in_range))
    return "its colour matrix or neutral is not finite";
  return {};
}

Result<std::string> checked_head(const std::filesystem::path& file, const RawFrame& frame, Size size,
                                 const DngTags& tags) {
  if (const std::string fault = fault_of(frame, size, tags); !fault.empty()) {
    return Error{ErrorKind::kUsage, "frame cannot be written as DNG", file.string(), fault,
                 "correct the camera of the scene"};
  }
  return dng_head(frame, size, tags);
}

using Bytes = std::vector<std::uint8_t>;

Result<Bytes> whole_file(const std::filesystem::path& file, const RawFrame& frame, const DngTags& tags) {
  const bool is_mosaic = frame.counts.planes() == 1;
  const View<const std::uint16_t> counts = frame.counts.plane();
  const Result<std::string> head = checked_head(file, frame, is_mosaic ? counts.size() : Size(), tags);
  if (!head) return head.error();
  const std::size_t row_bytes = sizeof(std::uint16_t) * static_cast<std::size_t>(counts.width());
  Bytes bytes;
  bytes.reserve(head->size() + strip_bytes(counts.size()));
  bytes.assign(head->begin(), head->end());
  for (int y = 0; y < counts.height(); ++y) {
    const auto* row = reinterpret_cast<const std::uint8_t*>(counts.row(y));
    bytes.insert(bytes.end(), row, row + row_bytes);
  }
  return bytes;
}

}  // namespace

Result<void> write_dng(const std::filesystem::path& file, const RawFrame& frame, const DngTags& tags) {
  const Result<Bytes> bytes = whole_file(file, frame, tags);
  if (!bytes) return bytes.error();
  return write_file(file, {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
}

Result<std::vector<std::uint8_t>> dng_bytes(const RawFrame& frame, const DngTags& tags) {
  return whole_file("DNG", frame, tags);
}

Result<DngWriter> DngWriter::open(const std::filesystem::path& file, const RawFrame& frame, Size size,
                                  const DngTags& tags) {
  const Result<std::string> head = checked_head(file, frame, size, tags);
  if (!head) return head.error();
  DngWriter writer;
  writer.file_ = file;
  writer.out_.reset(std::fopen(file.c_str(), "wbx"));
  if (!writer.out_) return cannot_write(file, errno);
  if (std::fwrite(head->data(), 1, head->size(), writer.out_.get()) != head->size()) {
    return cannot_write(file, errno);
  }
  return writer;
}

Result<void> DngWriter::write_rows(View<const std::uint16_t> rows) {
  const auto width = static_cast<std::size_t>(rows.width());
  for (int y = 0; y < rows.height(); ++y) {
    if (std::fwrite(rows.row(y), sizeof(std::uint16_t), width, out_.get()) != width) {
      return cannot_write(file_, errno);
    }
  }
  return {};
}

Result<void> DngWriter::finish() {
  if (std::fclose(out_.release()) != 0) return cannot_write(file_, errno);
  return {};
}

}  // namespace weft::simulator
