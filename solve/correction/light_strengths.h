// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/image.h"
#include "core/rig/light_field.h"

namespace weft::solve {

/// The strengths of all lights over a frame, asked of the field once a cell of its grid and straight between:
/// for what goes over the frame several times.
class LightStrengths {
 public:
  /// On this many threads; the field must outlive this.
  LightStrengths(const LightField& field, Size size, int threads);

  /// Strengths of light k in channel c at columns x0 <= x < x1 of row y.
  void read(std::size_t k, int c, int y, int x0, int x1, float* strength) const;

 private:
  static constexpr int kCell = LightField::kCell;
  int columns_, rows_;         // corners of cells
  std::vector<float> corner_;  // [((k * 3 + c) * rows + row) * columns + column]
};

}  // namespace weft::solve
