// SPDX-License-Identifier: Apache-2.0
#include "solver/in_double/pixelwise.h"
#include "solver/method.h"

namespace weft::solver {
namespace {

// A method that PixelSolver runs on one pixel after another.
class InDouble : public Method {
 public:
  InDouble(Estimator estimator, bool shadow_mask) : estimator_(estimator), shadow_mask_(shadow_mask) {}
  void solve(const TileInput& input, const TileOutput& output) const override {
    PixelSolver solver({.planes = input.planes,
                        .shadow_mask = shadow_mask_,
                        .noise = input.noise,
                        .estimator = estimator_,
                        .plane_weights = input.plane_weights});
    solve_each_pixel(input, output, [&](std::span<const PixelRow> rows) { return solver.solve(rows); });
  }

 private:
  Estimator estimator_;
  bool shadow_mask_;
};

}  // namespace

std::unique_ptr<Method> exact_method() {
  return std::make_unique<InDouble>(Estimator::kTrimmed, true);
}
std::unique_ptr<Method> exact_standard_method() {
  return std::make_unique<InDouble>(Estimator::kRejecting, true);
}
std::unique_ptr<Method> least_absolute_method() {
  return std::make_unique<InDouble>(Estimator::kLeastAbsolute, false);
}
std::unique_ptr<Method> sparse_method() {
  return std::make_unique<InDouble>(Estimator::kSparse, false);
}

}  // namespace weft::solver
