// SPDX-License-Identifier: Apache-2.0
#include "core/image/fourier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/base/vec.h"

namespace weft {
namespace {

TEST(FourierTransform, OfAPrimeLengthKeepsThirteenDigits) {
  // One wave of a whole frame's prime length: all in one coefficient.
  constexpr std::size_t kLength = 12289, kWave = 1234;
  std::vector<FourierTransform::Complex> wave(kLength), spectrum(kLength);
  for (std::size_t n = 0; n < kLength; ++n) {
    wave[n] = std::polar(1.0, 2 * kPi * static_cast<double>(kWave * n % kLength) / double{kLength});
  }
  FourierTransform(kLength).forward(wave.data(), spectrum.data());
  for (std::size_t k = 0; k < kLength; ++k) {
    const double want = k == kWave ? double{kLength} : 0;
    ASSERT_LT(std::abs(spectrum[k] - want), 1e-13 * kLength * 10) << "coefficient " << k;
  }
}

// One wave of a plane, `kx` periods along its rows and `ky` along its columns.
Image<std::complex<float>> wave_of(Size size, int kx, int ky) {
  Image<std::complex<float>> plane(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double turns =
          static_cast<double>(kx * x) / size.width + static_cast<double>(ky * y) / size.height;
      plane(x, y) = std::complex<float>(std::polar(1.0, 2 * kPi * turns));
    }
  }
  return plane;
}

TEST(FourierTransform, OfAPlaneHasOneCoefficientForOneWave) {
  const Size size = {211, 96};  // a prime and a smooth length
  Image<std::complex<float>> plane = wave_of(size, 17, 31);
  transform_plane(plane.plane(), 2);
  const double all = static_cast<double>(size.pixels());
  double worst = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::complex<double> found = plane(x, y);
      worst = std::max(worst, std::abs(found - (x == 17 && y == 31 ? all : 0)) / all);
    }
  }
  EXPECT_LT(worst, 3e-7);
}

TEST(FourierTransform, OfAPlaneIsTheSameForAnyNumberOfThreads) {
  const Size size = {100, 77};
  Image<std::complex<float>> one = wave_of(size, 3, 5), many = wave_of(size, 3, 5);
  transform_plane(one.plane(), 1);
  transform_plane(many.plane(), 5);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) ASSERT_EQ(one(x, y), many(x, y)) << x << ", " << y;
  }
}

}  // namespace
}  // namespace weft
