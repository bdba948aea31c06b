// SPDX-License-Identifier: Apache-2.0
#include "material/finish/periodic_height.h"

#include <complex>
#include <cstddef>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/image/fourier.h"

namespace weft::material {
namespace {

// Radians a pixel of each coefficient; 0 where the wave's derivative has no sign.
std::vector<double> wave_numbers(int length) {
  std::vector<double> out(static_cast<std::size_t>(length));
  for (int k = 0; k < length; ++k) {
    const int sign = 2 * k < length ? k : 2 * k > length ? k - length : 0;
    out[static_cast<std::size_t>(k)] = 2 * kPi * sign / length;
  }
  return out;
}

double mean_of(View<const float> plane) {
  double sum = 0;
  for (int y = 0; y < plane.height(); ++y) {
    double row = 0;
    for (int x = 0; x < plane.width(); ++x) row += static_cast<double>(plane(x, y));
    sum += row;
  }
  return sum / (static_cast<double>(plane.width()) * plane.height());
}

}  // namespace

// One complex plane holds both slopes, since each alone has a spectrum of mirrored conjugates; on the way
// back one plane holds both gradients.
PeriodicHeight periodic_height(const Image<float>& slope, int threads) {
  using Complex = std::complex<double>;
  const Size size = slope.size();
  PeriodicHeight out = {Image<float>(size), Image<float>(size, 2), mean_of(slope.plane(0)),
                        mean_of(slope.plane(1))};
  Image<std::complex<float>> both(size), height(size);
  const auto rows = [&](auto&& body) {
    parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
      for (int x = 0; x < size.width; ++x) body(x, static_cast<int>(row));
    });
  };
  rows([&](int x, int y) {
    both(x, y) = {slope(x, y, 0) - static_cast<float>(out.mean_right),
                  slope(x, y, 1) - static_cast<float>(out.mean_up)};
  });
  transform_plane(both.plane(), threads);
  const auto across = wave_numbers(size.width), down = wave_numbers(size.height);
  rows([&](int x, int y) {
    const Complex here = both(x, y),
                  there = std::conj(both((size.width - x) % size.width, (size.height - y) % size.height));
    const Complex right = 0.5 * (here + there), up = Complex(0, -0.5) * (here - there);
    const double u = across[static_cast<std::size_t>(x)], v = -down[static_cast<std::size_t>(y)];  // y is up
    const double squares = u * u + v * v;
    const Complex z = squares > 0 ? Complex(0, -1) * (u * right + v * up) / squares : 0;
    height(x, y) = std::complex<float>(std::conj(z) / static_cast<double>(size.pixels()));
  });
  // The forward transform of conjugates is the conjugate of the inverse one.
  rows([&](int x, int y) {
    const double u = across[static_cast<std::size_t>(x)], v = -down[static_cast<std::size_t>(y)];
    const Complex z = std::conj(Complex(height(x, y)));
    both(x, y) = std::complex<float>(std::conj(Complex(0, u) * z + Complex(0, 1) * Complex(0, v) * z));
  });
  transform_plane(height.plane(), threads);
  transform_plane(both.plane(), threads);
  rows([&](int x, int y) {
    out.height(x, y) = height(x, y).real();
    out.slope(x, y, 0) = both(x, y).real();
    out.slope(x, y, 1) = -both(x, y).imag();
  });
  return out;
}

}  // namespace weft::material
