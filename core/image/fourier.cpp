// SPDX-License-Identifier: Apache-2.0
#include "core/image/fourier.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/vec.h"

namespace weft {
namespace {

constexpr std::size_t kLargestPlainFactor = 31;
// Lines of a plane that are transformed together: columns fill a cache line of samples.
constexpr int kLinesAtOnce = 8;

std::size_t largest_prime_factor(std::size_t n) {
  std::size_t largest = 1;
  for (std::size_t p = 2; p * p <= n; ++p) {
    for (; n % p == 0; n /= p) largest = p;
  }
  return std::max(largest, n);
}

bool needs_chirp(std::size_t length) {
  return largest_prime_factor(length) > kLargestPlainFactor;
}

// Long enough for a linear convolution with a chirp of -length .. length, and quick for kissfft.
std::size_t convolution_length(std::size_t length) {
  std::size_t smooth = 2 * length - 1;
  while (largest_prime_factor(smooth) > 5) ++smooth;
  return smooth;
}

}  // namespace

// k n = (k^2 + n^2 - (k - n)^2) / 2 makes the transform a convolution with exp(pi i n^2 / length).
FourierTransform::FourierTransform(std::size_t length)
    : length_(length), smooth_(needs_chirp(length) ? convolution_length(length) : length, false) {
  if (!needs_chirp(length)) return;
  const std::size_t padded = convolution_length(length);
  chirp_.resize(length);
  work_.resize(padded);
  spectrum_.resize(padded);
  chirp_spectrum_.resize(padded);
  for (std::size_t n = 0; n < length; ++n) {
    const std::size_t square = n * n % (2 * length);  // exact: the angle itself would lose its digits
    chirp_[n] = std::polar(1.0, -kPi * static_cast<double>(square) / static_cast<double>(length));
    work_[n] = std::conj(chirp_[n]);
    if (n > 0) work_[padded - n] = work_[n];
  }
  smooth_.transform(work_.data(), chirp_spectrum_.data());
}

void FourierTransform::forward(const Complex* in, Complex* out) {
  if (chirp_.empty()) return smooth_.transform(in, out);
  for (std::size_t n = 0; n < length_; ++n) work_[n] = in[n] * chirp_[n];
  std::fill(work_.begin() + static_cast<std::ptrdiff_t>(length_), work_.end(), Complex{});
  smooth_.transform(work_.data(), spectrum_.data());
  // The conjugate of a forward transform of conjugates is the inverse one.
  for (std::size_t k = 0; k < spectrum_.size(); ++k) {
    spectrum_[k] = std::conj(spectrum_[k] * chirp_spectrum_[k]);
  }
  smooth_.transform(spectrum_.data(), work_.data());
  const double scale = 1 / static_cast<double>(work_.size());
  for (std::size_t k = 0; k < length_; ++k) out[k] = std::conj(work_[k]) * chirp_[k] * scale;
}

void transform_plane(View<std::complex<float>> plane, int threads) {
  const int width = plane.width(), height = plane.height();
  threads = std::max(1, resolved_threads(threads));
  const auto transform_lines = [&](int count, int length, const auto& sample) {
    const auto n = static_cast<std::size_t>(length);
    const FourierTransform prepared(n);
    std::vector<FourierTransform> transforms(static_cast<std::size_t>(threads), prepared);
    const int groups = (count + kLinesAtOnce - 1) / kLinesAtOnce;
    parallel_for(static_cast<std::size_t>(groups), threads, [&](std::size_t group, int worker) {
      const int first = static_cast<int>(group) * kLinesAtOnce, lines = std::min(kLinesAtOnce, count - first);
      std::vector<FourierTransform::Complex> in(n * kLinesAtOnce), out(n);
      for (int i = 0; i < length; ++i) {
        for (int line = 0; line < lines; ++line)
          in[static_cast<std::size_t>(line) * n + static_cast<std::size_t>(i)] = sample(first + line, i);
      }
      for (int line = 0; line < lines; ++line) {
        const auto from = in.begin() + static_cast<std::ptrdiff_t>(n) * line;
        transforms[static_cast<std::size_t>(worker)].forward(&*from, out.data());
        std::copy(out.begin(), out.end(), from);
      }
      for (int i = 0; i < length; ++i) {
        for (int line = 0; line < lines; ++line)
          sample(first + line, i) =
              std::complex<float>(in[static_cast<std::size_t>(line) * n + static_cast<std::size_t>(i)]);
      }
    });
  };
  transform_lines(height, width, [&](int line, int i) -> std::complex<float>& { return plane(i, line); });
  transform_lines(width, height, [&](int line, int i) -> std::complex<float>& { return plane(line, i); });
}

double frequency(int k, int length) {
  return (k <= length / 2 ? k : k - length) / static_cast<double>(length);
}

int mirrored(int i, int length) {
  const int turn = 2 * length;
  const int at = ((i % turn) + turn) % turn;
  return at < length ? at : turn - 1 - at;
}

}  // namespace weft
