// SPDX-License-Identifier: Apache-2.0
#include "solver/method.h"

namespace weft::solver {

std::span<const MethodName> method_names() {
  static constexpr std::array<MethodName, 11> kNames = {
      {{"preview", true, false, &least_squares_method, Extent::kHalfSize},
       {"fast", true, false, &fast_method},
       {"standard", true, false, &standard_method},
       {"robust", true, false, &robust_method},
       {"reference", true, false, &exact_method, Extent::kWholeFrame},
       {"seed", false, true, &seed_method},
       {"least-squares", false, true, &least_squares_method},
       {"wls", false, false, &weighted_method},
       {"l1", false, false, &least_absolute_method},
       {"sbl", false, false, &sparse_method},
       {"lts", false, false, &trimmed_method}}};
  return kNames;
}

SolveTally& SolveTally::operator+=(const SolveTally& other) {
  by_kernel += other.by_kernel;
  by_normal_equations += other.by_normal_equations;
  by_qr += other.by_qr;
  by_svd += other.by_svd;
  unsolved += other.unsolved;
  rejected_readings += other.rejected_readings;
  return *this;
}

}  // namespace weft::solver
