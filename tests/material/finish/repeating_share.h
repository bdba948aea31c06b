// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/solve/solve_record.h"
#include "material/surface.h"

namespace weft::material {

/// The share of the slopes' variance that comes again in every repeat, 0 to 1: of an analysis of variance by
/// place in the repeat, so that few repeats do not look alike by chance. Places are a pixel wide at most.
/// Pixels without a solution are left out.
inline double repeating_share(const Surface& surface, double repeat_x, double repeat_y) {
  struct Place {
    double n = 0, sum = 0;
  };
  const auto place_in = [](int i, double repeat) {
    return std::floor((i / repeat - std::floor(i / repeat)) * std::ceil(repeat));
  };
  double between = 0, total = 0;
  for (int p = 0; p < 2; ++p) {
    std::map<std::pair<double, double>, Place> places;
    double n = 0, sum = 0, squares = 0;
    for (int y = 0; y < surface.size().height; ++y) {
      for (int x = 0; x < surface.size().width; ++x) {
        if ((surface.status(x, y) & kNoSolution) != 0) continue;
        const double value = static_cast<double>(surface.slope(x, y, p));
        Place& place = places[{place_in(x, repeat_x), place_in(y, repeat_y)}];
        place.n += 1;
        place.sum += value;
        n += 1;
        sum += value;
        squares += value * value;
      }
    }
    const auto filled = static_cast<double>(places.size());
    if (n <= filled) return 0;
    double of_places = 0;
    for (const auto& [at, place] : places) of_places += place.sum * place.sum / place.n;
    const double within = (squares - of_places) / (n - filled);
    between += std::max(of_places - sum * sum / n - (filled - 1) * within, 0.0);
    total += squares - sum * sum / n;
  }
  return total > 0 ? between / total : 0;
}

}  // namespace weft::material
