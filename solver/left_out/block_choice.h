// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "core/image/image.h"
#include "solver/left_out/blocks.h"
#include "solver/method.h"

namespace weft::solver {

/// Which of two ways each block of a frame is solved: by the base (0) or by the better (1). Between the
/// centres of blocks the weight is bilinear, beyond the outer centres that of the edge.
class BlockChoice {
 public:
  /// `weights` are 0 or 1, by block of `grid`.
  BlockChoice(BlockGrid grid, std::vector<float> weights);

  const std::vector<float>& weights() const { return weights_; }
  double share() const;  ///< mean of the weights: 0 is the base everywhere
  float weight_at(int x, int y) const;

 private:
  BlockGrid grid_;
  std::vector<float> weights_;
};

/// The base where the choice is 0, the better where it is 1. Between, both: normals are blended and
/// normalised, albedo, sigma and residual are blended, status is of the heavier. `base` and `better` must
/// outlive it.
std::unique_ptr<Method> blended_method(const Method& base, const Method& better, BlockChoice choice);

}  // namespace weft::solver
