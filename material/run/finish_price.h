// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/image/image.h"
#include "material/run/maps.h"

// What finishing costs on grids of other pixels, and what each loses, before it is done.

namespace weft::material {

/// Seconds of one step of the recipe, or of what is done around the steps.
struct StepPrice {
  std::string name;  ///< "rectify", the step's, "write": maps, pictures and checks
  double seconds = 0;
};
void describe(Fields& fields, StepPrice& price);

/// One grid.
struct GridPrice {
  double mm_per_pixel = 0;
  Size size;  ///< before the recipe cuts it
  double seconds = 0;
  std::vector<StepPrice> steps = {};
  double lost_deg = 0;     ///< rms angle of the finest grid's normals to that of the coarser pixel over them
  bool is_chosen = false;  ///< the finest that the wish allows; with to_deg the coarsest
};
void describe(Fields& fields, GridPrice& price);

/// At most one of both.
struct GridWish {
  std::optional<double> to_deg, within_s;

  bool is_one() const { return to_deg || within_s; }
};

struct FinishPrices {
  std::vector<GridPrice> rows;  ///< the coarsest first, the last as fine as `options` asks for
};
void describe(Fields& fields, FinishPrices& prices);

/// Finishes the session as make_maps() does on grids four times and twice as coarse, in the system's
/// temporary folder, and says by these what the finest takes, each step by a constant and its pixels.
/// A grid that is too coarse for the recipe is left out; where both are, the finest is tried itself.
/// What is rectified for the finest grid stays, and is not made again. Errors of make_maps(); kUsage with
/// what is possible where no grid is as quick as is wished.
Result<FinishPrices> price_finish(const MapsOptions& options, const GridWish& wish,
                                  const JobContext& context);

}  // namespace weft::material
