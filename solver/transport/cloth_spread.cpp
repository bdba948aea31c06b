// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/cloth_spread.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/image/fourier.h"

namespace weft::solver {
namespace {

using Complex = std::complex<float>;

constexpr double kCellsADistance = 1.5;  // of l
constexpr double kFarthest = 12;         // of l: what comes from beyond is lost

double length_of(double mean) {
  return 2 * mean / std::numbers::pi;
}

// The next length without a prime factor above 5: transforms of it are quick.
int smooth_length(int at_least) {
  for (int length = at_least;; ++length) {
    int rest = length;
    for (const int prime : {2, 3, 5}) {
      while (rest % prime == 0) rest /= prime;
    }
    if (rest == 1) return length;
  }
}

// share K / (1 - share + share K) at each frequency, seen in the middles, over the length of the inverse
// transform.
void filter(View<Complex> spectrum, SeenAt place, double share, double mean_cells) {
  const int width = spectrum.width(), height = spectrum.height();
  const double scale = 1 / (static_cast<double>(width) * height);
  for (int y = 0; y < height; ++y) {
    const double fy = frequency(y, height);
    for (int x = 0; x < width; ++x) {
      const double fx = frequency(x, width), seen = seen_of_wave(share, mean_cells, std::hypot(fx, fy));
      const auto turned = std::polar(scale * (seen - (1 - share)) / seen,
                                     -2 * std::numbers::pi * (fx * place.x + fy * place.y));
      spectrum.row(y)[x] *= Complex(turned);
    }
  }
}

void conjugate(View<Complex> plane) {
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) plane.row(y)[x] = std::conj(plane.row(y)[x]);
  }
}

}  // namespace

double seen_of_wave(double share, double mean, double frequency) {
  const double t = 2 * std::numbers::pi * length_of(mean) * frequency;
  return 1 - share + share / (1 + t * t);
}

int side_of_spread_cells(double mean_px, bool of_mosaic) {
  const int step = of_mosaic ? 2 : 1;
  return std::max(step, step * static_cast<int>(std::lround(length_of(mean_px) / (step * kCellsADistance))));
}

Image<float> light_from_beside(const Image<float>& seen, std::span<const SeenAt> places, double share,
                               double mean_cells, int threads) {
  const int far = static_cast<int>(std::ceil(kFarthest * length_of(mean_cells)));
  const Size padded = {smooth_length(seen.width() + 2 * far), smooth_length(seen.height() + 2 * far)};
  Image<float> beside(seen.size(), seen.planes());
  Image<Complex> work(padded);
  for (int p = 0; p < seen.planes(); ++p) {
    for (int y = 0; y < padded.height; ++y) {
      const int from = mirrored(y - far, seen.height());
      for (int x = 0; x < padded.width; ++x) work(x, y) = seen(mirrored(x - far, seen.width()), from, p);
    }
    transform_plane(work.plane(), threads);
    filter(work.plane(), places[static_cast<std::size_t>(p)], share, mean_cells);
    conjugate(work.plane());
    transform_plane(work.plane(), threads);
    for (int y = 0; y < seen.height(); ++y) {
      for (int x = 0; x < seen.width(); ++x) beside(x, y, p) = work(x + far, y + far).real();
    }
  }
  return beside;
}

}  // namespace weft::solver
