// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/image/image.h"

namespace weft::material {

/// A line across a strip where two pictures of it are closest to each other, one place a row.
struct Cut {
  std::vector<int> column;  ///< of each row; from row to row by at most one, the last one to the first too
  double cost = 0;          ///< mean over the rows
};

/// The closed cut of the least cost by dynamic programming (Efros and Freeman 2001), at least `margin`
/// columns from the strip's sides. `cost` has a row for each row of the strip. Of the closed cuts those
/// through `starts` evenly spaced columns of the first row are compared.
Cut least_cut(View<const float> cost, int margin, int starts = 9);

/// The cost that no closed cut is below: of an open one.
double least_open_cost(View<const float> cost, int margin);

}  // namespace weft::material
