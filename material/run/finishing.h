// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/solve/verdict.h"
#include "material/run/map_set_facts.h"
#include "material/run/recipe.h"
#include "material/surface.h"
#include "report/drawing.h"

namespace weft::material {

/// What is known of the cloth beside its maps.
struct FinishingInput {
  /// Slow slopes that the calibration does not tell from none, degrees: up to these flattening does nothing.
  double slow_sigma_deg = 0;
  /// A preview goes on with a part of about so many pixels in the middle, or as many as the tile that is
  /// asked for takes, from the first step on that works by repeats and has none after it that names places.
  /// 0: all.
  std::int64_t most_px = 0;
};

/// What a step shows of what it found, to lie beside the maps.
struct StepPicture {
  std::string file;
  report::Picture picture;
};

/// What the steps of a recipe found and did.
struct FinishingFacts {
  std::vector<Json> steps;        ///< one a step
  std::vector<Verdict> verdicts;  ///< what speaks against the result
  Image<float> removed;           ///< slopes that flattening took off, on the grid it found; empty: none
  std::vector<StepPicture> pictures;
  FinishedPlace place;
  std::vector<double> part_mm;  ///< width and height of a preview's part, then of the cloth; empty: all of it
  bool is_detail = false;       ///< albedo is over its mean: no reflectance
  double yarn_px = 0;           ///< width of a yarn where a repeat was looked for; 0: not known
};

/// Does what the recipe says to all maps of a surface together. Errors: of the steps, with their number;
/// kInterrupted.
Result<FinishingFacts> finish_surface(Surface& surface, const Recipe& recipe, const FinishingInput& input,
                                      const JobContext& context);

}  // namespace weft::material
