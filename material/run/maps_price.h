// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "material/run/maps.h"

namespace weft::material {

/// One setting of a map, tried on a piece of the very cloth.
struct MapPrice {
  std::string map;        ///< "occlusion"
  std::string setting;    ///< "8 directions"
  double seconds = 0;     ///< of the whole map, from the time of the piece
  double error = 0;       ///< rms against the best that there is, on the piece
  std::string unit = {};  ///< of the error: "share", "mm"
  bool is_default = false;
  bool is_chosen = false;  ///< by what was asked of the error or the time
};

/// What is asked of the dearest map, occlusion.
struct PriceAims {
  std::optional<double> to = {};        ///< rms of openness that is good enough
  std::optional<double> within_s = {};  ///< for the whole map
};

struct MapPrices {
  std::vector<MapPrice> rows;
  int directions = 0;  ///< of occlusion, as the aims choose them
};

/// Seconds and errors of heights (each way to integrate, against the direct solution) and of occlusion (4, 8
/// and 16 directions, against 64), on a piece of 512 x 512 pixels from the middle of the rectified maps.
/// Seconds are by the number of pixels. The aims choose the quickest occlusion that is good enough, else the
/// best that is in time; without aims the default is chosen. Errors as of make_maps().
Result<MapPrices> price_maps(const MapsOptions& options, const PriceAims& aims, const JobContext& context);
Json json_of(const MapPrices& prices);

}  // namespace weft::material
