// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tiffio.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace weft {

/// A TIFF of one strip a plane, as other programs write it. `fields` are tags of 16 bits.
struct ForeignTiff {
  int width = 4, height = 2;
  std::vector<std::pair<std::uint32_t, int>> fields = {};
  std::vector<std::uint8_t> bytes = {};   ///< of the rows, or of one plane after the other
  std::vector<std::uint16_t> table = {};  ///< reds, greens, blues of a palette
  int extra = -1;                         ///< what the last sample of a pixel is
  const char* mode = "w";
};

inline bool write_foreign(const std::filesystem::path& file, const ForeignTiff& image) {
  TIFF* tiff = TIFFOpen(file.c_str(), image.mode);
  if (tiff == nullptr) return false;
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, image.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, image.height);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, image.height);
  for (const auto& [tag, value] : image.fields) TIFFSetField(tiff, tag, value);
  const std::size_t colors = image.table.size() / 3;
  if (colors > 0)
    TIFFSetField(tiff, TIFFTAG_COLORMAP, image.table.data(), image.table.data() + colors,
                 image.table.data() + 2 * colors);
  const auto extra = static_cast<std::uint16_t>(image.extra);
  if (image.extra >= 0) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &extra);
  const std::uint32_t strips = TIFFNumberOfStrips(tiff);
  const std::size_t each = image.bytes.size() / strips;
  bool written = true;
  for (std::uint32_t s = 0; s < strips; ++s) {
    std::vector<std::uint8_t> strip(image.bytes.begin() + static_cast<std::ptrdiff_t>(s * each),
                                    image.bytes.begin() + static_cast<std::ptrdiff_t>((s + 1) * each));
    written &= TIFFWriteEncodedStrip(tiff, s, strip.data(), static_cast<tmsize_t>(each)) >= 0;
  }
  TIFFClose(tiff);
  return written;
}

inline std::vector<std::pair<std::uint32_t, int>> tiff_fields(int bits, int samples, int photometric) {
  return {{TIFFTAG_BITSPERSAMPLE, bits},
          {TIFFTAG_SAMPLESPERPIXEL, samples},
          {TIFFTAG_PHOTOMETRIC, photometric},
          {TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG}};
}

/// 4 x 2 pixels of each kind that stores more than numbers of a known full scale.
inline std::vector<std::pair<std::string, ForeignTiff>> foreign_tiffs() {
  const std::vector<std::uint8_t> eight = {0, 51, 102, 153, 204, 255, 10, 20};
  std::vector<std::uint8_t> ink;
  for (const std::uint8_t each : eight) ink.insert(ink.end(), {each, 0, 255, 51});
  std::vector<std::uint8_t> planes;
  for (int p = 0; p < 3; ++p) {
    for (const std::uint8_t each : eight) planes.push_back(static_cast<std::uint8_t>(each / (p + 1)));
  }
  auto separate = tiff_fields(8, 3, PHOTOMETRIC_RGB);
  separate.back().second = PLANARCONFIG_SEPARATE;
  std::vector<std::uint8_t> sixteen;  // in the order of this machine, which libtiff turns
  for (const int count : {0, 1, 256, 513, 32768, 65535, 4660, 43981})
    sixteen.insert(sixteen.end(),
                   {static_cast<std::uint8_t>(count & 255), static_cast<std::uint8_t>(count >> 8)});
  std::vector<std::uint16_t> table(3 * 16);
  for (std::size_t i = 0; i < 16; ++i) {
    table[i] = static_cast<std::uint16_t>(257 * 17 * i);
    table[16 + i] = static_cast<std::uint16_t>(65535 - table[i]);
    table[32 + i] = 256 * 100;  // as some programs write a count of 8 bits
  }
  std::vector<std::uint8_t> with_alpha;
  for (const std::uint8_t each : eight) with_alpha.insert(with_alpha.end(), {each, 128});
  return {
      {"palette",
       {.fields = tiff_fields(4, 1, PHOTOMETRIC_PALETTE), .bytes = {0x01, 0x23, 0xEF, 0x84}, .table = table}},
      {"white_is_0", {.fields = tiff_fields(8, 1, PHOTOMETRIC_MINISWHITE), .bytes = eight}},
      {"white_is_0_of_1_bit", {.fields = tiff_fields(1, 1, PHOTOMETRIC_MINISWHITE), .bytes = {0x50, 0xA0}}},
      {"one_bit", {.fields = tiff_fields(1, 1, PHOTOMETRIC_MINISBLACK), .bytes = {0x50, 0xA0}}},
      {"ink", {.fields = tiff_fields(8, 4, PHOTOMETRIC_SEPARATED), .bytes = ink}},
      {"separate", {.fields = separate, .bytes = planes}},
      {"big", {.fields = tiff_fields(8, 1, PHOTOMETRIC_MINISBLACK), .bytes = eight, .mode = "w8"}},
      {"big_endian", {.fields = tiff_fields(16, 1, PHOTOMETRIC_MINISBLACK), .bytes = sixteen, .mode = "wb"}},
      {"associated",
       {.fields = tiff_fields(8, 2, PHOTOMETRIC_MINISBLACK),
        .bytes = with_alpha,
        .extra = EXTRASAMPLE_ASSOCALPHA}}};
}

}  // namespace weft
