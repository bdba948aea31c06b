// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/live_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/statistics.h"
#include "core/image_io/encode_image.h"
#include "simulator/effects/random_key.h"
#include "simulator/sampling/random.h"

namespace weft::virtual_rig {
namespace {

constexpr int kLongSide_px = 640;
constexpr double kGrey = 0.35;       // linear, of the brightest half
constexpr double kMostGain = 200;    // over a reading of full scale
constexpr double kReadNoise = 2e-4;  // of full scale
constexpr double kGamma = 1 / 2.2;

/// Light of one cell of filters, red, green and blue, full scale being 1.
using Cell = std::array<double, 3>;

Cell cell_at(const LightFrames& frames, const GatheredLight& light, int x, int y) {
  const auto gathered = [&](int column, int row) {
    double sum = light.ambient_s > 0 ? light.ambient_s * frames.ambient()(column, row) : 0;
    for (int led = 1; led <= frames.leds(); ++led) {
      const double seconds = light.leds_s[static_cast<std::size_t>(led - 1)];
      if (seconds > 0) sum += seconds * frames.led(led)(column, row);
    }
    return sum * light.aperture_gain * light.iso / 100;
  };
  return {gathered(x, y), 0.5 * (gathered(x + 1, y) + gathered(x, y + 1)), gathered(x + 1, y + 1)};
}

/// From the middle of the brighter half: a dark surround does not count.
double gain_of(std::vector<double> values) {
  return std::min(kGrey / std::max(lower_quantile(std::move(values), 0.75), 1e-9), kMostGain);
}

}  // namespace

std::vector<std::uint8_t> live_picture(const LightFrames& frames, const GatheredLight& light) {
  const Size size = frames.size();
  const int step = 2 * ((std::max(size.width, size.height) + 2 * kLongSide_px - 1) / (2 * kLongSide_px));
  const int width = size.width / step, height = size.height / step;
  std::array<std::vector<double>, 3> planes;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Cell cell = cell_at(frames, light, std::clamp(x * step - light.move_x, 0, size.width - 2) & ~1,
                                std::clamp(y * step - light.move_y, 0, size.height - 2) & ~1);
      for (std::size_t c = 0; c < 3; ++c) planes[c].push_back(cell[c]);
    }
  }
  const Rgb& balance = frames.scene().lights.white_balance;
  double white_gain = kMostGain;
  for (std::size_t c = 0; c < 3; ++c) white_gain = std::min(white_gain, balance[c] * gain_of(planes[c]));
  std::vector<std::uint8_t> picture;
  const auto key = simulator::random_key(frames.scene());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const simulator::NormalPair noise = simulator::normal_pair(
          simulator::philox({static_cast<std::uint32_t>(at), light.noise_key, 0, 2}, key));
      for (std::size_t c = 0; c < 3; ++c) {
        const double seen =
            white_gain / balance[c] * (planes[c][at] + kReadNoise * (c == 1 ? noise.first : noise.second));
        const double shown = 255 * std::pow(std::clamp(seen, 0.0, 1.0), kGamma);
        picture.push_back(static_cast<std::uint8_t>(std::lround(shown)));
      }
    }
  }
  const Result<std::string> jpeg = encode_image(picture, {width, height}, 3, PictureFormat::kLiveJpeg);
  return jpeg ? std::vector<std::uint8_t>(jpeg->begin(), jpeg->end()) : std::vector<std::uint8_t>();
}

}  // namespace weft::virtual_rig
