// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/weighted.h"
#include "solver/method.h"

namespace weft::solver {
namespace {

class Weighted : public Method {
 public:
  explicit Weighted(Estimator estimator, double trim_from = kTrimFrom)
      : estimator_(estimator), trim_from_(trim_from) {}
  void solve(const TileInput& input, const TileOutput& output) const override {
    solve_weighted(input, output, estimator_, trim_from_);
  }

 private:
  Estimator estimator_;
  double trim_from_;
};

}  // namespace

std::unique_ptr<Method> weighted_method() {
  return std::make_unique<Weighted>(Estimator::kWeighted);
}
std::unique_ptr<Method> standard_method() {
  return std::make_unique<Weighted>(Estimator::kRejecting);
}
std::unique_ptr<Method> robust_method() {
  return std::make_unique<Weighted>(Estimator::kTrimmed);
}
std::unique_ptr<Method> trimmed_method() {
  return std::make_unique<Weighted>(Estimator::kTrimmed, 0.0);
}

}  // namespace weft::solver
