// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "solver/method.h"
#include "solver/reflectance/lobe.h"
#include "solver/reflectance/lobe_readings.h"

namespace weft::solver {

/// A lobe, and what of it is open.
struct KnownLobe {
  Lobe lobe;
  std::vector<Lobe> one_sigma_off = {};  ///< of solver/reflectance/lobe_fit.h; empty: nothing is open
  Lobe tint_off = {};  ///< with another tint, one sigma off in all channels; counts where `lobe` is tinted
};

/// `base`, and each pixel that it solves again with lobes that are known, whichever costs it least: from
/// where the base left it and, where that does not explain its readings, from other normals. Such a pixel has
/// the bit GLOSSY, by the second lobe SECOND_LOBE, where its yarn lies across the axis YARN_ACROSS, and the
/// bits of the base, but for SPECULAR. Pixels that Lambert's law costs least, where it is among the lobes,
/// stay as the base left them. A pixel that neither of two lobes explains is solved as a blend of both
/// (blend.h), where that explains it; status_blend.h says their shares. Its sigmas are those of the readings
/// and of what is open of its lobe, to first order. At most two lobes that shine, before Lambert's. `base`
/// must outlive it. Readings are fitted over `unit`, as the lobes were; albedo is written as the base has it.
std::unique_ptr<Method> glossy_method(const Method& base, std::vector<KnownLobe> lobes, Sight sight,
                                      double unit = 1);

/// A pixel's cost over the degrees of freedom of its readings, from which other normals are tried.
inline constexpr double kTryOthersFrom = 2;

}  // namespace weft::solver
