// SPDX-License-Identifier: Apache-2.0
#include "solver/height/cosine_transform.h"

#include <algorithm>

#include "core/vec.h"

namespace weft::solver {
namespace {

using Complex = FourierTransform::Complex;

constexpr std::size_t kLargestPlainFactor = 31;

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

CosineTransform::CosineTransform(std::size_t length)
    : length_(length), fourier_(length), turn_(length), folded_(length), spectrum_(length) {
  for (std::size_t k = 0; k < length; ++k) {
    turn_[k] = std::polar(1.0, -kPi * static_cast<double>(k) / (2 * static_cast<double>(length)));
  }
}

void CosineTransform::forward(double* first, double* second) {
  const std::size_t n = length_;
  // Even samples forwards, then odd ones backwards: a period that needs no mirror image.
  for (std::size_t i = 0; 2 * i < n; ++i) folded_[i] = {first[2 * i], second[2 * i]};
  for (std::size_t i = 0; 2 * i + 1 < n; ++i) folded_[n - 1 - i] = {first[2 * i + 1], second[2 * i + 1]};
  fourier_.forward(folded_.data(), spectrum_.data());
  first[0] = spectrum_[0].real();
  second[0] = spectrum_[0].imag();
  for (std::size_t k = 1; 2 * k <= n; ++k) {
    const Complex here = spectrum_[k], there = std::conj(spectrum_[n - k]);
    const Complex of_first = 0.5 * (here + there) * turn_[k];
    const Complex i_of_second = 0.5 * (here - there) * turn_[k];
    first[k] = of_first.real();
    second[k] = i_of_second.imag();
    first[n - k] = -of_first.imag();
    second[n - k] = i_of_second.real();
  }
}

void CosineTransform::inverse(double* first, double* second) {
  const std::size_t n = length_;
  const double scale = 1 / static_cast<double>(n);
  // Real and imaginary part change places before and after: the forward transform then is the inverse.
  folded_[0] = {scale * second[0], scale * first[0]};
  for (std::size_t k = 1; k < n; ++k) {
    const Complex of_first = Complex(first[k], -first[n - k]) * std::conj(turn_[k]);
    const Complex of_second = Complex(second[k], -second[n - k]) * std::conj(turn_[k]);
    folded_[k] = {scale * (of_first.imag() + of_second.real()), scale * (of_first.real() - of_second.imag())};
  }
  fourier_.forward(folded_.data(), spectrum_.data());
  for (std::size_t i = 0; 2 * i < n; ++i) {
    first[2 * i] = spectrum_[i].imag();
    second[2 * i] = spectrum_[i].real();
  }
  for (std::size_t i = 0; 2 * i + 1 < n; ++i) {
    first[2 * i + 1] = spectrum_[n - 1 - i].imag();
    second[2 * i + 1] = spectrum_[n - 1 - i].real();
  }
}

}  // namespace weft::solver
