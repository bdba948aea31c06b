// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "solver/light_plan/light_plan.h"

namespace weft::calibration {

/// A cloth that lights are planned for.
struct NamedCloth {
  std::string name;
  solver::ForeseenCloth cloth;
};

/// The cloths that kClothKinds names; plausible, not measured (docs/reflectance.md).
const std::vector<NamedCloth>& planned_cloths();

/// The first observable lobe of a reflectance.json (schema weft.reflectance/1). One whose f0 is known only
/// over the albedo takes `albedo`. kBadData where nothing was observable.
Result<NamedCloth> cloth_of_reflectance(const std::filesystem::path& file, std::optional<double> albedo);

}  // namespace weft::calibration
