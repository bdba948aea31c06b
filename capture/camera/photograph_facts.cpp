// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/photograph_facts.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/base/number.h"
#include "core/base/text.h"

namespace weft::capture {
namespace {

enum Tag : std::uint16_t {  // TIFF 6.0, Exif 2.32, TIFF/EP, DNG 1.4
  kMake = 271,
  kModel = 272,
  kStripOffsets = 273,
  kOrientation = 274,
  kStripByteCounts = 279,
  kTileOffsets = 324,
  kTileByteCounts = 325,
  kExposureTime = 33434,
  kFNumber = 33437,
  kExif = 34665,
  kIso = 34855,
  kDateTimeOriginal = 36867,
  kOffsetTimeOriginal = 36881,
  kImageNumber = 37393,
  kMakerNote = 37500,
  kSubSecTimeOriginal = 37521,
  kLensModel = 42036,
  kDngVersion = 50706,
  kNikonShutterCount = 0x00A7,
};

using Header = std::array<std::uint8_t, 8>;

/// The same file with another directory as its first: how Tiff reads a directory that the main chain only
/// points at.
std::optional<Tiff> tiff_from(const ReadAt& read_at, std::uint64_t directory) {
  Header header;
  if (!read_at(0, header) || directory > std::numeric_limits<std::uint32_t>::max()) return {};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t byte = header[0] == 'M' ? 3 - i : i;
    header[4 + i] = static_cast<std::uint8_t>(directory >> (8 * byte));
  }
  return Tiff::read([read_at, header](std::uint64_t offset, std::span<std::uint8_t> bytes) {
    if (offset != 0 || bytes.size() != header.size()) return read_at(offset, bytes);
    std::ranges::copy(header, bytes.begin());
    return true;
  });
}

/// A tag of the first directory or, failing that, of the EXIF directory.
struct Directories {
  const Tiff& main;
  const std::optional<Tiff>& exif;

  std::optional<double> number(std::uint16_t id) const {
    for (const Tiff* tiff : both()) {
      if (tiff == nullptr) continue;
      if (const auto value = tiff->number(tiff->directories()[0], id)) return value;
    }
    return {};
  }
  std::optional<std::string> text(std::uint16_t id) const {
    for (const Tiff* tiff : both()) {
      if (tiff == nullptr) continue;
      if (auto value = tiff->text(tiff->directories()[0], id)) return value;
    }
    return {};
  }
  std::array<const Tiff*, 2> both() const { return {exif ? &*exif : nullptr, &main}; }
};

std::optional<int> digits(std::string_view text) {
  return text.starts_with('-') ? std::nullopt : as_whole_number<int>(text);
}

/// "2026:01:31 23:59:58" in seconds since 1970.
std::optional<double> seconds_of(std::string_view text) {
  if (text.size() != 19 || text[4] != ':' || text[7] != ':' || text[10] != ' ' || text[13] != ':' ||
      text[16] != ':')
    return {};
  const auto year = digits(text.substr(0, 4)), month = digits(text.substr(5, 2)),
             day = digits(text.substr(8, 2)), hour = digits(text.substr(11, 2)),
             minute = digits(text.substr(14, 2)), second = digits(text.substr(17, 2));
  if (!year || !month || !day || !hour || !minute || !second) return {};
  const auto date = std::chrono::year(*year) / *month / *day;
  if (!date.ok() || *hour > 23 || *minute > 59 || *second > 60) return {};
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600.0 * *hour + 60.0 * *minute + *second;
}

/// "+05:30" in seconds.
std::optional<double> zone_of(std::string_view text) {
  if (text.size() != 6 || (text[0] != '+' && text[0] != '-') || text[3] != ':') return {};
  const auto hours = digits(text.substr(1, 2)), minutes = digits(text.substr(4, 2));
  if (!hours || !minutes || *hours > 14 || *minutes > 59) return {};
  return (text[0] == '-' ? -60.0 : 60.0) * (60.0 * *hours + *minutes);
}

void read_time(const Directories& tags, PhotographFacts& facts) {
  const auto when = tags.text(kDateTimeOriginal);
  if (!when) return;
  facts.taken_s = seconds_of(*when);
  if (const auto zone = tags.text(kOffsetTimeOriginal)) facts.zone_s = zone_of(*zone);
  auto fraction = tags.text(kSubSecTimeOriginal);
  if (!facts.taken_s || !fraction) return;
  fraction->erase(fraction->find_last_not_of(' ') + 1);
  const auto value = fraction->size() > 6 ? std::nullopt : digits(*fraction);
  if (!value) return;
  facts.resolution_s = std::pow(0.1, static_cast<double>(fraction->size()));
  *facts.taken_s += *value * facts.resolution_s;
}

std::optional<std::uint32_t> whole(std::optional<double> number) {
  if (!number || *number < 0 || *number > 0xffffffff || *number != std::floor(*number)) return {};
  return static_cast<std::uint32_t>(*number);
}

/// The shutter count of a type 3 maker note: "Nikon", a version, then a TIFF of its own whose offsets count
/// from its header.
std::optional<std::uint32_t> nikon_shutter_count(const ReadAt& read_at, const std::optional<Tiff>& exif) {
  constexpr std::uint64_t kTiffAt = 10;
  if (!exif) return {};
  const TiffTag* note = Tiff::find(exif->directories()[0], kMakerNote);
  if (note == nullptr) return {};
  std::array<std::uint8_t, 6> name;
  if (!read_at(note->at, name) || std::memcmp(name.data(), "Nikon", name.size()) != 0) return {};
  const std::uint64_t base = note->at + kTiffAt;
  const auto inner = Tiff::read([&read_at, base](std::uint64_t offset, std::span<std::uint8_t> bytes) {
    return read_at(base + offset, bytes);
  });
  if (!inner) return {};
  return whole(inner->number(inner->directories()[0], kNikonShutterCount));
}

std::string tiff_ending(const ReadAt& read_at, const Tiff& tiff) {
  const TiffDirectory& first = tiff.directories()[0];
  std::array<std::uint8_t, 2> mark;
  if (Tiff::find(first, kDngVersion) != nullptr) return "dng";
  if (read_at(8, mark) && mark[0] == 'C' && mark[1] == 'R') return "cr2";
  const std::string make = tiff.text(first, kMake).value_or("");
  if (make.starts_with("NIKON")) return "nef";
  if (make.starts_with("SONY")) return "arw";
  if (make.starts_with("PENTAX")) return "pef";
  return "tif";
}

/// Where the last strip or tile of any image in the file ends.
std::uint64_t data_end(const Tiff& tiff) {
  double end = 0;
  for (const TiffDirectory& directory : tiff.directories()) {
    for (const auto& [offset_tag, bytes_tag] :
         {std::pair{kStripOffsets, kStripByteCounts}, {kTileOffsets, kTileByteCounts}}) {
      const std::vector<double> offsets = tiff.numbers(directory, offset_tag);
      const std::vector<double> bytes = tiff.numbers(directory, bytes_tag);
      for (std::size_t i = 0; i < std::min(offsets.size(), bytes.size()); ++i)
        end = std::max(end, offsets[i] + bytes[i]);
    }
  }
  return static_cast<std::uint64_t>(std::min(end, 1e15));
}

/// How files that are no TIFF begin, by the readers of LibRaw 0.20.
struct Beginning {
  std::string_view ending;
  std::size_t at;
  std::string_view bytes;
};
constexpr Beginning kJpeg = {"jpg", 0, "\xff\xd8\xff"};
constexpr std::array<Beginning, 9> kUnreadRaws = {{{"cr3", 4, "ftypcrx "},
                                                   {"rw2", 0, {"IIU\0", 4}},
                                                   {"orf", 0, "IIRO"},
                                                   {"orf", 0, "IIRS"},
                                                   {"orf", 0, "MMOR"},
                                                   {"raf", 0, "FUJIFILM"},
                                                   {"crw", 6, "HEAPCCDR"},
                                                   {"mrw", 0, {"\0MRM", 4}},
                                                   {"x3f", 0, "FOVb"}}};

bool begins(const ReadAt& read_at, const Beginning& as) {
  std::array<std::uint8_t, 8> bytes;
  return read_at(as.at, std::span(bytes).first(as.bytes.size())) &&
         std::memcmp(bytes.data(), as.bytes.data(), as.bytes.size()) == 0;
}

std::string ending_of_no_tiff(const ReadAt& read_at) {
  if (begins(read_at, kJpeg)) return std::string(kJpeg.ending);
  const auto raw = std::ranges::find_if(kUnreadRaws, [&](const auto& as) { return begins(read_at, as); });
  return raw == kUnreadRaws.end() ? "" : std::string(raw->ending);
}

std::uint32_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

constexpr int kMostParts = 10000;  // of a file, that are walked through

/// Where the EXIF of a JPEG begins (JEITA CP-3451, 4.5.4): the segment APP1 of that name, before the image.
std::optional<std::uint64_t> exif_of_jpeg(const ReadAt& read_at) {
  constexpr std::string_view kName("Exif\0\0", 6);
  std::array<std::uint8_t, 10> segment;
  std::uint64_t at = 2;
  for (int i = 0; i < kMostParts && read_at(at, segment) && segment[0] == 0xff; ++i) {
    const std::uint8_t marker = segment[1];
    if (marker == 0xda || marker == 0xd9) return {};
    if (marker == 0xe1 && std::memcmp(&segment[4], kName.data(), kName.size()) == 0)
      return at + segment.size();
    at += 2 + big_endian(std::span(segment).subspan(2, 2));
  }
  return {};
}

/// Where the chunk eXIf of a PNG (third edition, 11.3.3.4) begins.
std::optional<std::uint64_t> exif_of_png(const ReadAt& read_at) {
  std::array<std::uint8_t, 8> chunk;
  std::uint64_t at = 8;
  for (int i = 0; i < kMostParts && read_at(at, chunk); ++i) {
    if (std::memcmp(&chunk[4], "eXIf", 4) == 0) return at + chunk.size();
    at += 12 + std::uint64_t{big_endian(std::span(chunk).first(4))};
  }
  return {};
}

constexpr Beginning kPng = {"png", 0, "\x89PNG\r\n\x1a\n"};

/// The TIFF that a JPEG or a PNG carries along.
std::optional<Tiff> carried_exif(const ReadAt& read_at) {
  const std::optional<std::uint64_t> at = begins(read_at, kJpeg)  ? exif_of_jpeg(read_at)
                                          : begins(read_at, kPng) ? exif_of_png(read_at)
                                                                  : std::nullopt;
  if (!at) return {};
  return Tiff::read([read_at, base = *at](std::uint64_t offset, std::span<std::uint8_t> bytes) {
    return read_at(base + offset, bytes);
  });
}

double at_least_0(std::optional<double> value) {
  return std::max(0.0, value.value_or(0));
}

}  // namespace

bool is_raw_ending(const std::string& ending) {
  return ending == "dng" || ending == "nef" || ending == "cr2" || ending == "arw" || ending == "pef";
}

bool is_unread_raw_ending(const std::string& ending) {
  return std::ranges::any_of(kUnreadRaws, [&](const auto& raw) { return raw.ending == ending; });
}

bool is_raw_name(const std::filesystem::path& file) {
  const std::string ending = small_letters(file.extension().string());
  if (ending.empty()) return false;
  const std::string told = ending == ".nrw" ? "nef" : ending.substr(1);
  return is_raw_ending(told) || is_unread_raw_ending(told);
}

PhotographFacts photograph_facts(const ReadAt& read_at) {
  PhotographFacts facts;
  std::optional<Tiff> main = Tiff::read(read_at);
  if (main) {
    facts.ending = tiff_ending(read_at, *main);
    facts.data_end = data_end(*main);
  } else {
    facts.ending = ending_of_no_tiff(read_at);
    main = carried_exif(read_at);
  }
  if (!main) return facts;
  const auto exif_at = whole(main->number(main->directories()[0], kExif));
  const auto read_from_main = [&main](std::uint64_t offset, std::span<std::uint8_t> bytes) {
    return main->read_at(offset, bytes);
  };
  const std::optional<Tiff> exif = exif_at ? tiff_from(read_from_main, *exif_at) : std::nullopt;

  const Directories tags{*main, exif};
  read_time(tags, facts);
  facts.model = tags.text(kModel).value_or("");
  facts.lens = tags.text(kLensModel).value_or("");
  const double orientation = main->number(main->directories()[0], kOrientation).value_or(1);
  if (orientation >= 1 && orientation <= 8) facts.orientation = static_cast<int>(orientation);
  facts.image_number = whole(tags.number(kImageNumber));
  if (!facts.image_number) facts.image_number = nikon_shutter_count(read_at, exif);
  facts.exposure_us = 1e6 * at_least_0(tags.number(kExposureTime));
  facts.iso = at_least_0(tags.number(kIso));
  facts.f_number = at_least_0(tags.number(kFNumber));
  return facts;
}

Result<PhotographFacts> read_photograph_facts(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_other(file, ignored) || std::filesystem::is_fifo(file, ignored)) {
    return Error{ErrorKind::kBadData, "not a picture", file.string(), "it is a pipe, a socket or a device",
                 "give a file, or take it out of the folder"};
  }
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return cannot_read(file, errno);
  PhotographFacts facts = photograph_facts([fd](std::uint64_t offset, std::span<std::uint8_t> bytes) {
    if (offset > static_cast<std::uint64_t>(std::numeric_limits<off_t>::max())) return false;
    return ::pread(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset)) ==
           static_cast<ssize_t>(bytes.size());
  });
  ::close(fd);
  return facts;
}

}  // namespace weft::capture
