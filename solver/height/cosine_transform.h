// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/fourier.h"

namespace weft::solver {

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
