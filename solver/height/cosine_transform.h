// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <kissfft/kissfft.hh>

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

namespace weft::solver {

/// Discrete Fourier transform of any length in double. kissfft takes a time proportional to the largest prime
/// factor, so lengths with a large one go through Bluestein's chirp (1970), a convolution of a smooth length.
/// One object a thread: kissfft and the convolution keep scratch.
class FourierTransform {
 public:
  using Complex = std::complex<double>;
  explicit FourierTransform(std::size_t length);
  /// out[k] = sum of in[n] exp(-2 pi i k n / length); `in` and `out` do not overlap.
  void forward(const Complex* in, Complex* out);

 private:
  std::size_t length_;
  kissfft<double> smooth_;  ///< of length_, or of the convolution
  std::vector<Complex> chirp_, chirp_spectrum_, work_, spectrum_;
};

/// Cosine transform (DCT-II and its inverse) of two rows at a time, which share one complex transform of
/// their length (Makhoul 1980). One object a thread.
class CosineTransform {
 public:
  explicit CosineTransform(std::size_t length);
  /// values[k] becomes the sum of values[n] cos(pi k (2 n + 1) / (2 length)), in both rows.
  void forward(double* first, double* second);
  /// Undoes forward.
  void inverse(double* first, double* second);

 private:
  std::size_t length_;
  FourierTransform fourier_;
  std::vector<FourierTransform::Complex> turn_;  ///< exp(-pi i k / (2 length))
  std::vector<FourierTransform::Complex> folded_, spectrum_;
};

}  // namespace weft::solver
