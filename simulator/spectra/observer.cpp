// SPDX-License-Identifier: Apache-2.0
#include "simulator/spectra/observer.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

namespace weft::simulator {
namespace {

using Samples = std::array<double, Spectrum::kSamples>;

/// CIE standard illuminant D65 (ISO/CIE 11664-2), relative to 100 at 560 nm.
constexpr Samples kD65 = {49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812,
                          114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
                          100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
                          80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856};

/// ITU-R BT.709 primaries with white D65.
constexpr std::array<std::array<double, 3>, 3> kRec709FromXyz = {{{3.2404542, -1.5371385, -0.4985314},
                                                                  {-0.9692660, 1.8760108, 0.0415560},
                                                                  {0.0556434, -0.2040259, 1.0572252}}};

/// A bell whose halves have widths of their own.
double lobe(double nm, double centre, double left, double right) {
  const double t = (nm - centre) / (nm < centre ? left : right);
  return std::exp(-0.5 * t * t);
}

std::array<double, 3> observer_xyz(double nm) {
  return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
              0.065 * lobe(nm, 501.1, 20.4, 26.2),
          0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
          1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

double sum(const Samples& samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0);
}

void divide(Samples& samples, double by) {
  for (double& s : samples) s /= by;
}

ChannelWeights weights_of_rec709() {
  ChannelWeights weights{};
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i) {
    const auto xyz = observer_xyz(Spectrum::nm(i));
    for (std::size_t c = 0; c < 3; ++c) {
      weights[c][i] = kD65[i] * std::inner_product(xyz.begin(), xyz.end(), kRec709FromXyz[c].begin(), 0.0);
    }
  }
  for (Samples& channel : weights) divide(channel, sum(channel));
  return weights;
}

/// Light of the LED that each channel records, by wavelength.
Result<ChannelWeights> recorded(const Spectrum& led, const Filters& filters) {
  ChannelWeights light{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < Spectrum::kSamples; ++i) light[c][i] = led.samples[i] * filters[c].samples[i];
    if (!(sum(light[c]) > 1e-9)) {
      return Error{ErrorKind::kBadData, "the camera does not see the LED", "filters",
                   fmt::format("channel {} passes nothing of its light", "RGB"[c]),
                   "give the LED and the filters wavelengths in common"};
    }
  }
  return light;
}

}  // namespace

Result<ChannelWeights> camera_weights(const Spectrum& led, const Filters& filters) {
  auto weights = recorded(led, filters);
  if (!weights) return weights;
  for (Samples& channel : *weights) divide(channel, sum(channel));
  return weights;
}

const ChannelWeights& rec709_weights() {
  static const ChannelWeights weights = weights_of_rec709();
  return weights;
}

ChannelWeights observer_weights() {
  ChannelWeights weights{};
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i) {
    const auto xyz = observer_xyz(Spectrum::nm(i));
    for (std::size_t c = 0; c < 3; ++c) weights[c][i] = xyz[c];
  }
  for (Samples& channel : weights) divide(channel, sum(channel));
  return weights;
}

Rgb channel_reflectance(const ChannelWeights& weights, const Spectrum& reflectance) {
  Rgb seen{};
  for (std::size_t c = 0; c < 3; ++c) {
    seen[c] = std::inner_product(weights[c].begin(), weights[c].end(), reflectance.samples.begin(), 0.0);
  }
  return seen;
}

Result<Rgb> camera_white_balance(const Spectrum& led, const Filters& filters) {
  const auto light = recorded(led, filters);
  if (!light) return light.error();
  const double green = sum((*light)[1]);
  return Rgb{sum((*light)[0]) / green, 1, sum((*light)[2]) / green};
}

std::array<double, 2> chromaticity(const Spectrum& light) {
  std::array<double, 3> total{};
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i) {
    const auto xyz = observer_xyz(Spectrum::nm(i));
    for (std::size_t c = 0; c < 3; ++c) total[c] += light.samples[i] * xyz[c];
  }
  const double all = total[0] + total[1] + total[2];
  return {total[0] / all, total[1] / all};
}

}  // namespace weft::simulator
