// SPDX-License-Identifier: Apache-2.0
#include "solver/height/cosine_transform.h"

#include "core/base/vec.h"

namespace weft::solver {
namespace {

using Complex = FourierTransform::Complex;

}  // namespace

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
