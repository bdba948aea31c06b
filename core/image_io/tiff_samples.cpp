// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/tiff_samples.h"

#include <Imath/half.h>

#include <cstring>
#include <limits>

#include "core/image_io/image_source.h"

namespace weft {
namespace {

/// Numbers below a byte, or astride of two, begin at the high bit.
std::uint32_t bits_at(const std::byte* row, std::size_t at, int bits) {
  std::uint32_t value = 0;
  for (int i = 0; i < bits; ++i, ++at) {
    const auto byte = std::to_integer<unsigned>(row[at / 8]);
    value = value << 1 | (byte >> (7 - at % 8) & 1U);
  }
  return value;
}

template <typename Number>
Number number_at(const std::byte* row, std::size_t at) {
  Number number;
  std::memcpy(&number, row + at * sizeof(Number), sizeof(Number));
  return number;
}

template <typename Number, typename Value>
void unpack_as(const std::byte* row, std::size_t first, std::size_t step, View<float> out,
               const Value& value) {
  float* samples = out.row(0);
  for (int x = 0; x < out.width(); ++x, first += step) samples[x] = value(number_at<Number>(row, first));
}

template <typename Number>
void unpack_scaled(const std::byte* row, std::size_t first, std::size_t step, View<float> out) {
  constexpr double kFull = std::numeric_limits<Number>::max();
  unpack_as<Number>(row, first, step, out,
                    [](Number n) { return static_cast<float>(static_cast<double>(n) / kFull); });
}

void unpack_floats(const std::byte* row, int bits, std::size_t first, std::size_t step, View<float> out) {
  if (bits == 16) {
    unpack_as<std::uint16_t>(row, first, step, out, imath_half_to_float);
  } else if (bits == 32) {
    unpack_as<float>(row, first, step, out, [](float v) { return v; });
  } else {
    unpack_as<double>(row, first, step, out, [](double v) { return static_cast<float>(v); });
  }
}

void unpack_signed(const std::byte* row, int bits, std::size_t first, std::size_t step, View<float> out) {
  if (bits == 8) {
    unpack_scaled<std::int8_t>(row, first, step, out);
  } else if (bits == 16) {
    unpack_scaled<std::int16_t>(row, first, step, out);
  } else {
    unpack_scaled<std::int32_t>(row, first, step, out);
  }
}

}  // namespace

bool TiffSample::is_known() const {
  switch (kind) {
    case Kind::kCount:
      return (bits >= 1 && bits <= 16) || bits == 32;
    case Kind::kSigned:
      return bits == 8 || bits == 16 || bits == 32;
    case Kind::kFloat:
      return bits == 16 || bits == 32 || bits == 64;
  }
  return false;
}

SampleType TiffSample::type() const {
  if (kind == Kind::kFloat) return bits == 16 ? SampleType::kHalf : SampleType::kFloat;
  if (kind == Kind::kSigned || bits > 16) return SampleType::kFloat;
  return bits > 8 ? SampleType::kUint16 : SampleType::kUint8;
}

void unpack_tiff(const std::byte* row, TiffSample sample, std::size_t first, std::size_t step,
                 View<float> out) {
  if (sample.kind == TiffSample::Kind::kFloat) return unpack_floats(row, sample.bits, first, step, out);
  if (sample.kind == TiffSample::Kind::kSigned) return unpack_signed(row, sample.bits, first, step, out);
  if (sample.bits == 8) return unpack_counts(reinterpret_cast<const std::uint8_t*>(row) + first, step, out);
  if (sample.bits == 16) return unpack_counts(reinterpret_cast<const std::uint16_t*>(row) + first, step, out);
  if (sample.bits == 32) return unpack_scaled<std::uint32_t>(row, first, step, out);
  const double full = static_cast<double>((1U << sample.bits) - 1);
  float* samples = out.row(0);
  for (int x = 0; x < out.width(); ++x, first += step)
    samples[x] =
        static_cast<float>(bits_at(row, first * static_cast<std::size_t>(sample.bits), sample.bits) / full);
}

void unpack_indices(const std::byte* row, int bits, std::size_t count, std::vector<std::uint16_t>& out) {
  out.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = bits == 16 ? number_at<std::uint16_t>(row, i)
                                           : bits_at(row, i * static_cast<std::size_t>(bits), bits);
    out[i] = static_cast<std::uint16_t>(index);
  }
}

}  // namespace weft
