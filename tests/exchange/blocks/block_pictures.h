// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "core/image/image.h"

// Pictures that tests of block formats encode.

namespace weft::test {

inline std::vector<View<const float>> views_of(const Image<float>& image) {
  std::vector<View<const float>> views;
  for (int p = 0; p < image.planes(); ++p) views.push_back(image.plane(p));
  return views;
}

/// value(x, y, plane) at every texel.
template <typename Value>
Image<float> drawn(Size size, int planes, const Value& value) {
  Image<float> image(size, planes);
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) image(x, y, p) = static_cast<float>(value(x, y, p));
    }
  }
  return image;
}

/// Red satin as sRGB: yarns of 9 and 12 texels, each of its own brightness, and grain of one per cent that
/// channels share.
inline Image<float> red_satin(Size size, int planes) {
  std::mt19937 random(7);
  std::vector<double> grain(static_cast<std::size_t>(size.pixels()));
  for (double& g : grain) g = 1 + 0.01 * (static_cast<double>(random() % 2001) / 1000 - 1);
  constexpr double kAlbedo[] = {0.45, 0.08, 0.12};
  return drawn(size, planes, [&](int x, int y, int p) {
    const int warp = x / 9, weft = y / 12;
    if (p == 3) return (2 * warp + weft) % 5 == 0 ? 0.75 : 1.0;
    const bool is_warp = (2 * warp + weft) % 5 != 0;
    const double across = is_warp ? x / 9.0 - warp : y / 12.0 - weft;
    const double yarn = 1 + 0.06 * std::sin(12.9 * (is_warp ? warp : weft + 100));
    const double linear = kAlbedo[p] * yarn * (0.8 + 0.2 * std::sin(3.14159265 * across)) *
                          grain[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                                static_cast<std::size_t>(x)];
    return 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  });
}

inline double largest_difference(const Image<float>& a, const Image<float>& b, int plane) {
  double most = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      most = std::max(most, std::abs(static_cast<double>(a(x, y, plane)) - b(x, y, plane)));
    }
  }
  return most;
}

/// Peak signal to noise of the first `planes` planes, in decibels.
inline double psnr_db(const Image<float>& a, const Image<float>& b, int planes) {
  double sum = 0;
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        const double off = static_cast<double>(a(x, y, p)) - b(x, y, p);
        sum += off * off;
      }
    }
  }
  return -10 * std::log10(sum / (static_cast<double>(a.size().pixels()) * planes));
}

}  // namespace weft::test
