// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "solver/method.h"
#include "solver/reflectance/lobe.h"
#include "solver/reflectance/lobe_readings.h"

namespace weft::solver {

/// `base`, and each pixel that it solves again with a lobe that is known: from where the base left it and,
/// where that does not explain its readings, from other normals; the least cost is kept. Such a pixel has
/// the bit GLOSSY, where its yarn lies across the axis YARN_ACROSS, and the bits of the base, but for
/// SPECULAR. `base` must outlive it.
std::unique_ptr<Method> glossy_method(const Method& base, const Lobe& lobe, Sight sight);

/// A pixel's cost over the degrees of freedom of its readings, from which other normals are tried.
inline constexpr double kTryOthersFrom = 2;

}  // namespace weft::solver
