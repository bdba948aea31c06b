// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/pack_row.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace weft {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// The truth of each conversion, one sample at a time and by its definition.

std::uint16_t half_of(float value) {
  const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
  const auto bits = [&](int magnitude) { return static_cast<std::uint16_t>(sign | magnitude); };
  if (std::isnan(value)) return bits(0x7E00);
  if (std::isinf(value)) return bits(0x7C00);
  const double a = std::min(std::abs(double{value}), 65504.0);
  const int exponent = a < std::ldexp(1.0, -14) ? -14 : std::ilogb(a);
  const int significand = static_cast<int>(std::nearbyint(std::ldexp(a, 10 - exponent)));  // ties to even
  return bits(((exponent + 14) << 10) + significand);
}

float value_of_half(std::uint16_t half) {
  const int exponent = (half >> 10) & 31, significand = half & 1023;
  const double magnitude =
      exponent == 0 ? std::ldexp(significand, -24) : std::ldexp(1024 + significand, exponent - 25);
  return static_cast<float>(half & 0x8000 ? -magnitude : magnitude);
}

template <typename Integer>
Integer integer_of(float value) {
  const float full = std::numeric_limits<Integer>::max();
  return static_cast<Integer>(value > 0 ? std::nearbyint(std::min(value, 1.0f) * full) : 0);
}

void pack_reference(const std::vector<const float*>& planes, std::size_t width, SampleType type,
                    std::byte* packed) {
  for (std::size_t x = 0; x < width; ++x) {
    for (const float* plane : planes) {
      const std::uint16_t half = half_of(plane[x]);
      const std::uint16_t count16 = integer_of<std::uint16_t>(plane[x]);
      const std::uint8_t count8 = integer_of<std::uint8_t>(plane[x]);
      const void* sample = type == SampleType::kFloat    ? static_cast<const void*>(plane + x)
                           : type == SampleType::kHalf   ? static_cast<const void*>(&half)
                           : type == SampleType::kUint16 ? static_cast<const void*>(&count16)
                                                         : static_cast<const void*>(&count8);
      std::memcpy(packed, sample, sample_bytes(type));
      packed += sample_bytes(type);
    }
  }
}

/// Runs `check` once on every SIMD target of this machine.
template <typename Check>
void on_every_target(const Check& check) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
}

std::vector<float> awkward_values() {
  std::vector<float> values = {0.0f, -0.0f, 1.0f, -1.0f, kNan, -kNan, kInf, -kInf, 1e-40f, 1e30f, -1e30f};
  for (const float v : {65503.0f, 65504.0f, 65519.9f, 65520.0f, 65536.0f})
    values.insert(values.end(), {v, -v});
  for (int k = -27; k <= -13; ++k) {  // around the ends of the subnormal numbers of binary16
    const float v = std::ldexp(1.0f, k);
    for (const float w : {v, 1.5f * v, std::nextafter(v, 1.0f), std::nextafter(v, 0.0f)}) {
      values.insert(values.end(), {w, -w});
    }
  }
  for (int k = 0; k < 256; ++k) values.push_back((static_cast<float>(k) + 0.5f) / 255.0f);
  for (int k = 0; k < 65536; k += 97) values.push_back((static_cast<float>(k) + 0.5f) / 65535.0f);
  for (int k = 0; k < 4096; ++k)
    values.push_back(1.0f + static_cast<float>(k) / 8192.0f);  // ties of binary16
  return values;
}

TEST(PackRow, AgreesWithItsDefinitionOnEveryTargetTypeWidthAndNumberOfPlanes) {
  const std::vector<float> values = awkward_values();
  for (const SampleType type :
       {SampleType::kUint8, SampleType::kUint16, SampleType::kHalf, SampleType::kFloat}) {
    for (const std::size_t planes : {1U, 2U, 3U, 4U, 5U, 8U}) {
      for (const std::size_t width : {std::size_t{1}, std::size_t{3}, std::size_t{7}, std::size_t{16},
                                      std::size_t{33}, std::size_t{61}, values.size() - planes}) {
        std::vector<const float*> rows(planes);
        for (std::size_t p = 0; p < planes; ++p) rows[p] = values.data() + p;  // any alignment
        std::vector<std::byte> wanted(width * planes * sample_bytes(type));
        pack_reference(rows, width, type, wanted.data());
        on_every_target([&] {
          std::vector<std::byte> packed(wanted.size());
          pack_row(rows, width, type, packed.data());
          const auto [at, _] = std::mismatch(packed.begin(), packed.end(), wanted.begin());
          const auto sample = static_cast<std::size_t>(at - packed.begin()) / sample_bytes(type);
          ASSERT_TRUE(at == packed.end())
              << "type " << static_cast<int>(type) << ", " << planes << " planes, width " << width
              << ", sample " << sample << " of " << rows[sample % planes][sample / planes];
        });
      }
    }
  }
}

TEST(PackRow, KeepsEveryFiniteHalfFloat) {
  std::vector<float> values;
  std::vector<std::uint16_t> halves;
  for (int bits = 0; bits < 65536; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    if ((half & 0x7C00) == 0x7C00) continue;
    halves.push_back(half);
    values.push_back(value_of_half(half));
  }
  const std::vector<const float*> row = {values.data()};
  on_every_target([&] {
    std::vector<std::uint16_t> packed(values.size());
    pack_row(row, values.size(), SampleType::kHalf, reinterpret_cast<std::byte*>(packed.data()));
    EXPECT_EQ(packed, halves);
  });
}

TEST(PackRow, RoundsFloatsOfEveryMagnitudeToTheNearestHalf) {
  std::vector<float> values;
  std::vector<std::uint16_t> halves;
  for (std::uint64_t bits = 0; bits < (std::uint64_t{1} << 32); bits += 16411) {
    values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    halves.push_back(half_of(values.back()));
  }
  const std::vector<const float*> row = {values.data()};
  on_every_target([&] {
    std::vector<std::uint16_t> packed(values.size());
    pack_row(row, values.size(), SampleType::kHalf, reinterpret_cast<std::byte*>(packed.data()));
    EXPECT_EQ(packed, halves);
  });
}

TEST(PackRow, KeepsEveryBitOfFloatsEvenOfNan) {
  const float odd_nan = std::bit_cast<float>(0xFFA12345U);
  const std::vector<const float*> row = {&odd_nan};
  on_every_target([&] {
    std::uint32_t packed = 0;
    pack_row(row, 1, SampleType::kFloat, reinterpret_cast<std::byte*>(&packed));
    EXPECT_EQ(packed, 0xFFA12345U);
  });
}

}  // namespace
}  // namespace weft
