// SPDX-License-Identifier: Apache-2.0
#include "solver/method.h"
#include "solver/normals/pixelwise.h"

namespace weft::solver {
namespace {

class Pixelwise : public Method {
 public:
  Pixelwise(Estimator estimator, double trim_from) : estimator_(estimator), trim_from_(trim_from) {}
  void solve(const TileInput& input, const TileOutput& output) const override {
    PixelSolver solver({input.planes, true, input.noise, estimator_, trim_from_});
    solve_each_pixel(input, output, [&](std::span<const PixelRow> rows) { return solver.solve(rows); });
  }

 private:
  Estimator estimator_;
  double trim_from_;
};

}  // namespace

std::unique_ptr<Method> weighted_method() {
  return std::make_unique<Pixelwise>(Estimator::kWeighted, kTrimFrom);
}
std::unique_ptr<Method> standard_method() {
  return std::make_unique<Pixelwise>(Estimator::kRejecting, kTrimFrom);
}
std::unique_ptr<Method> robust_method() {
  return std::make_unique<Pixelwise>(Estimator::kTrimmed, kTrimFrom);
}
std::unique_ptr<Method> trimmed_method() {
  return std::make_unique<Pixelwise>(Estimator::kTrimmed, 0.0);
}

}  // namespace weft::solver
