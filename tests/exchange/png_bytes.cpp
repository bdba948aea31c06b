// SPDX-License-Identifier: Apache-2.0
#include "tests/exchange/png_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace weft::exchange {

namespace {

void put_big_endian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((value >> shift) & 0xff);
}

void put_chunk(std::string& out, const std::string& type, const std::string& data) {
  const std::string body = type + data;
  put_big_endian(out, static_cast<std::uint32_t>(data.size()));
  out += body;
  put_big_endian(out, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                                                       static_cast<uInt>(body.size()))));
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  const int done = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 6);
  if (done != Z_OK) throw std::runtime_error("zlib did not compress");
  out.resize(size);
  return out;
}

}  // namespace

std::string png_bytes(Size size, int channels, int bits, const std::vector<double>& samples) {
  std::string rows;
  auto sample = samples.begin();
  for (int y = 0; y < size.height; ++y) {
    rows += '\0';  // no filter
    for (int i = 0; i < size.width * channels; ++i, ++sample) {
      const double most = bits == 16 ? 65535 : 255;
      const auto value = static_cast<unsigned>(std::lround(std::clamp(*sample, 0.0, 1.0) * most));
      if (bits == 16) rows += static_cast<char>(value >> 8);
      rows += static_cast<char>(value & 0xff);
    }
  }
  std::string header;
  put_big_endian(header, static_cast<std::uint32_t>(size.width));
  put_big_endian(header, static_cast<std::uint32_t>(size.height));
  header += static_cast<char>(bits);
  header += static_cast<char>(channels == 1 ? 0 : channels == 3 ? 2 : 6);
  header += std::string(3, '\0');
  std::string out = "\x89PNG\r\n\x1a\n";
  put_chunk(out, "IHDR", header);
  put_chunk(out, "IDAT", compressed(rows));
  put_chunk(out, "IEND", "");
  return out;
}

}  // namespace weft::exchange
