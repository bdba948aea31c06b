// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/image/image.h"
#include "solver/method.h"

namespace weft::solve {

class LightCorrection;

/// A copy of a tile's readings, in all states of the films, corrected. One serves a worker.
class CorrectedTile {
 public:
  /// Corrects what `input` reads: its readings are then those of the copy, until the next call.
  void apply(const LightCorrection& correction, solver::TileInput& input);

 private:
  Image<float> readings_;
  std::vector<View<const float>> views_;
};

}  // namespace weft::solve
