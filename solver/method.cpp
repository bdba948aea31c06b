// SPDX-License-Identifier: Apache-2.0
#include "solver/method.h"

#include <algorithm>

namespace weft::solver {

std::span<const MethodName> method_names() {
  static constexpr std::array kNames = {
      MethodName{.name = "preview",
                 .help = "half size, no masks",
                 .level = Level::kPreview,
                 .make = &least_squares_method,
                 .extent = Extent::kHalfSize},
      MethodName{.name = "fast",
                 .help = "least squares without shadows",
                 .level = Level::kFast,
                 .make = &fast_method},
      MethodName{.name = "standard",
                 .help = "weighted, misfits rejected; default",
                 .level = Level::kStandard,
                 .make = &standard_method},
      MethodName{.name = "robust", .help = "for highlights", .level = Level::kRobust, .make = &robust_method},
      MethodName{.name = "reference",
                 .help = "shadows and light between yarns taken out where the cloth needs it",
                 .level = Level::kReference,
                 .make = &robust_method,
                 .extent = Extent::kWholeFrame},
      MethodName{.name = "seed",
                 .help = "four systems a pixel by SVD, after demosaicing",
                 .keeps_clipped = true,
                 .make = &seed_method},
      MethodName{.name = "least-squares",
                 .help = "every valid reading",
                 .keeps_clipped = true,
                 .make = &least_squares_method},
      MethodName{.name = "wls", .help = "weighted", .make = &weighted_method},
      MethodName{.name = "l1", .help = "least absolute residuals", .make = &least_absolute_method},
      MethodName{.name = "sbl", .help = "sparse errors", .make = &sparse_method},
      MethodName{.name = "lts", .help = "least trimmed squares", .make = &trimmed_method}};
  return kNames;
}

const MethodName& method_of(Level level) {
  return *std::ranges::find(method_names(), level, &MethodName::level);
}

const MethodName* find_method(std::string_view name) {
  const auto names = method_names();
  const auto found = std::ranges::find(names, name, &MethodName::name);
  return found == names.end() ? nullptr : &*found;
}

double Method::reflected(const TileInput& input, const TileOutput& output, int x, int y, Vec3 light,
                         double /*lobe_share*/) const {
  const Vec3 n = {output.normal[0](x, y), output.normal[1](x, y), output.normal[2](x, y)};
  return output.albedo[input.planes == 1 ? 0 : 1](x, y) * std::max(0.0, dot(n, light));
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
