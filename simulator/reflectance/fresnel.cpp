// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/fresnel.h"

#include <cstddef>

namespace weft::simulator {
namespace {

double let_through(Beneath beneath, double f0, double fresnel, const Cosines& c) {
  switch (beneath) {
    case Beneath::kLambert:
      return 1;
    case Beneath::kBalanced:
      return 1 - fresnel;
    case Beneath::kCoupled:
      break;
  }
  return 21.0 / 20.0 * (1 - f0) * (1 - fifth_power_of_rest(c.n_l)) * (1 - fifth_power_of_rest(c.n_v));
}

}  // namespace

Rgb lobe_over_diffuse(double lobe, const Rgb& f0, Beneath beneath, const Rgb& albedo,
                      const Cosines& cosines) {
  Rgb f;
  for (std::size_t c = 0; c < f.size(); ++c) {
    const double fresnel = schlick(f0[c], cosines.l_h);
    f[c] = fresnel * lobe + let_through(beneath, f0[c], fresnel, cosines) * albedo[c] / kPi;
  }
  return f;
}

}  // namespace weft::simulator
