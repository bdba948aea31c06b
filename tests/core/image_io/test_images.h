// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/image_io/image_io.h"

namespace weft {

/// Random values that `type` holds exactly: counts of an integer, or eight bits of fraction with a sign.
inline Image<float> exact_noise(Size size, int planes, SampleType type, unsigned seed = 7) {
  std::mt19937 random(seed);
  Image<float> image(size, planes);
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const auto bits = static_cast<std::uint32_t>(random());
        switch (type) {
          case SampleType::kUint8:
            image(x, y, p) = static_cast<float>(bits & 0xFFU) / 255.0f;
            break;
          case SampleType::kUint16:
            image(x, y, p) = static_cast<float>(bits & 0xFFFFU) / 65535.0f;
            break;
          case SampleType::kHalf:
            image(x, y, p) = static_cast<float>(static_cast<int>(bits & 0xFFFU) - 2048) / 256.0f;
            break;
          case SampleType::kFloat:
            image(x, y, p) = static_cast<float>(static_cast<std::int32_t>(bits)) * 1e-7f;
            break;
        }
      }
    }
  }
  return image;
}

inline std::vector<View<const float>> views_of(const Image<float>& image) {
  std::vector<View<const float>> views;
  views.reserve(static_cast<std::size_t>(image.planes()));
  for (int p = 0; p < image.planes(); ++p) views.push_back(image.plane(p));
  return views;
}

/// The same rows of every view.
inline std::vector<View<const float>> rows_of(const std::vector<View<const float>>& views, int y0, int y1) {
  std::vector<View<const float>> rows;
  rows.reserve(views.size());
  for (const View<const float>& view : views) rows.push_back(view.crop({0, y0, view.width(), y1}));
  return rows;
}

inline std::vector<std::string> channel_names(int channels) {
  if (channels == 1) return {"Y"};
  std::vector<std::string> names = {"R", "G", "B", "A"};
  names.resize(static_cast<std::size_t>(channels));
  return names;
}

/// The first pixel at which two images differ in any bit, or nothing.
inline std::string first_difference(const Image<float>& a, const Image<float>& b) {
  if (a.size() != b.size() || a.planes() != b.planes()) return "another shape";
  for (int p = 0; p < a.planes(); ++p) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        if (std::bit_cast<std::uint32_t>(a(x, y, p)) == std::bit_cast<std::uint32_t>(b(x, y, p))) continue;
        return fmt::format("({}, {}, {}): {}, not {}", x, y, p, a(x, y, p), b(x, y, p));
      }
    }
  }
  return "";
}

/// Integers are compared by count: their quotient by full scale may round either way.
inline void round_to_counts(Image<float>& image, SampleType type) {
  const float full = type == SampleType::kUint8 ? 255.0f : type == SampleType::kUint16 ? 65535.0f : 0.0f;
  if (full == 0) return;
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        image(x, y, p) = static_cast<float>(std::lround(full * image(x, y, p)));
      }
    }
  }
}

}  // namespace weft
