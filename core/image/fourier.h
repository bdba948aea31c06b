// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <kissfft/kissfft.hh>

#include <complex>
#include <cstddef>
#include <vector>

#include "core/image/image.h"

namespace weft {

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

/// The same of a plane in place, along rows and along columns; at most `threads` threads (0: all). The same
/// bytes for any number of them. Arithmetic is in double, each of the two passes rounds to float32.
void transform_plane(View<std::complex<float>> plane, int threads);

/// Cycles a sample of number k of a transform of this length, from -1/2 to 1/2.
double frequency(int k, int length);

/// The sample, 0 to `length` - 1, that a mirror at either end shows at `i`.
int mirrored(int i, int length);

}  // namespace weft
