// SPDX-License-Identifier: Apache-2.0
#include "solver/method.h"

namespace weft::solver {

std::span<const MethodName> method_names() {
  static constexpr std::array<MethodName, 3> kNames = {
      {{"fast", true, false, &fast_method},
       {"seed", false, true, &seed_method},
       {"least-squares", false, true, &least_squares_method}}};
  return kNames;
}

}  // namespace weft::solver
