// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "exchange/presets/pack.h"

namespace weft::exchange {

/// Maps of a test: planes by a function of the pixel, or by a number.
class TestMaps {
 public:
  explicit TestMaps(Size size) : size_(size) {}

  void set(MapPlane plane, const std::function<double(int, int)>& value) {
    Image<float>& image = images_[static_cast<std::size_t>(plane)] = Image<float>(size_);
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) image(x, y) = static_cast<float>(value(x, y));
    }
    planes_[static_cast<std::size_t>(plane)] = {.pixels = image.plane()};
  }
  void set(MapPlane plane, double value) { planes_[static_cast<std::size_t>(plane)] = {.constant = value}; }

  /// Unit normals of slopes that are functions of the pixel: (-x, -y, 1).
  void set_slopes(const std::function<std::array<double, 2>(int, int)>& slope) {
    const auto part = [&](int c) {
      return [slope, c](int x, int y) {
        const auto [sx, sy] = slope(x, y);
        const double z = 1 / std::sqrt(sx * sx + sy * sy + 1);
        return c == 0 ? -sx * z : c == 1 ? -sy * z : z;
      };
    };
    set(MapPlane::kNormalX, part(0));
    set(MapPlane::kNormalY, part(1));
    set(MapPlane::kNormalZ, part(2));
  }

  const SourcePlanes& planes() const { return planes_; }
  Size size() const { return size_; }

  /// The samples of a file as it holds them, unrounded.
  Image<float> samples(const PresetFile& file, const ChannelFacts& facts = {}) const {
    Image<float> image(size_, static_cast<int>(file.channels.size()));
    const std::vector<View<float>> views = views_of(image);
    pack_values(file, planes_, facts, 0, views);
    to_samples(file, facts, views);
    return image;
  }

  static std::vector<View<float>> views_of(Image<float>& image) {
    std::vector<View<float>> views;
    for (int p = 0; p < image.planes(); ++p) views.push_back(image.plane(p));
    return views;
  }

  /// Samples as integers of that many bits hold them.
  static void round_to_bits(Image<float>& image, int bits) {
    const double most = std::exp2(bits) - 1;
    for (const View<float>& plane : views_of(image)) {
      for (int y = 0; y < plane.height(); ++y) {
        for (int x = 0; x < plane.width(); ++x) {
          const double v = std::min(1.0, std::max(0.0, static_cast<double>(plane(x, y))));
          plane(x, y) = static_cast<float>(std::nearbyint(v * most) / most);
        }
      }
    }
  }

 private:
  Size size_;
  std::array<Image<float>, kPlanes> images_;
  SourcePlanes planes_;
};

/// A file of a preset with these channels.
inline PresetFile file_of(std::vector<std::string> channels, Stored stored = {},
                          NormalDirection direction = NormalDirection::kOpenGl) {
  PresetFile file;
  file.name = "{name}.png";
  file.channels = std::move(channels);
  file.stored = stored;
  file.direction = direction;
  return file;
}

}  // namespace weft::exchange
