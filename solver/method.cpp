// SPDX-License-Identifier: Apache-2.0
#include "solver/method.h"

namespace weft::solver {

std::span<const MethodName> method_names() {
  static constexpr std::array<MethodName, 7> kNames = {
      {{"fast", true, false, &fast_method},
       {"standard", true, false, &standard_method},
       {"robust", true, false, &robust_method},
       {"seed", false, true, &seed_method},
       {"least-squares", false, true, &least_squares_method},
       {"wls", false, false, &weighted_method},
       {"lts", false, false, &trimmed_method}}};
  return kNames;
}

}  // namespace weft::solver
