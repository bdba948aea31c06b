// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/linear.h"
#include "solver/method.h"

namespace weft::solver {
namespace {

class LeastSquares : public Method {
 public:
  void solve(const TileInput& input, const TileOutput& output) const override {
    solve_linear(input, output, {.shadow_mask = false});
  }
};

}  // namespace

std::unique_ptr<Method> least_squares_method() {
  return std::make_unique<LeastSquares>();
}

}  // namespace weft::solver
