// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/image/color_spaces.h"
#include "simulator/reflectance/reflectance.h"

namespace weft::simulator {

/// The lobe of a model, in the terms that a solve measures one in.
struct LobeParameters {
  double alpha_across = 1, alpha_along = 1;  ///< of the yarn; alike where the lobe has no direction
  bool has_direction = false;
  Rgb f0 = {};
};

/// The parameters of GGX, GGX with two alphas, Beckmann and the cloth lobe. The other models have no lobe,
/// or one whose parameters are others: none.
std::optional<LobeParameters> lobe_parameters_of(const Reflectance& model);

}  // namespace weft::simulator
