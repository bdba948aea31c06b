// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/jobs/maps/recipe.h"
#include "core/job.h"
#include "core/json_document.h"
#include "core/result.h"
#include "core/verdict.h"
#include "material/surface.h"

namespace weft::app {

/// What the steps of a recipe found and did.
struct FinishingFacts {
  std::vector<Json> steps;        ///< one a step
  std::vector<Verdict> verdicts;  ///< what speaks against the result
};

/// Does what the recipe says to all maps of a surface together. Errors: of the steps, with their number;
/// kInterrupted.
Result<FinishingFacts> finish_surface(material::Surface& surface, const Recipe& recipe,
                                      const JobContext& context);

}  // namespace weft::app
