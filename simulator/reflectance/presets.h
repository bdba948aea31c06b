// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/image/color_spaces.h"
#include "simulator/reflectance/reflectance.h"

namespace weft::simulator {

/// A cloth by name. The numbers are plausible, not measured: refractive indices of the fibres give f0, the
/// rest is chosen to look right.
struct ClothPreset {
  struct Parameter {
    std::string name;
    std::string why;  ///< one line: what it stands for and why it has its value
  };

  std::string name;
  Reflectance reflectance;
  Rgb albedo;  ///< where the scene has none
  std::vector<Parameter> parameters;
};

/// All presets, from matte to shiny.
std::span<const ClothPreset> presets();

/// The preset of that name; kBadData with all names, the nearest first, where there is none.
Result<ClothPreset> preset(std::string_view name);

}  // namespace weft::simulator
