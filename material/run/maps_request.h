// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "material/run/finish_price.h"
#include "material/run/maps.h"
#include "material/run/maps_price.h"

namespace weft::material {

/// What `weft maps` and a job that makes maps are told.
struct MapsRequest {
  MapsOptions maps;
  std::filesystem::path recipe;  ///< a file, or the name of one that weft brings along; empty: none
  Json steps;                    ///< in place of `recipe`; null: none
  bool is_strict = false;
  bool only_explains = false;
  PriceAims aims;

  /// The recipe that is asked for. kNoInput, kBadData, kUsage.
  Result<Recipe> asked_recipe() const;
};
void describe(Fields& fields, MapsRequest& request);

/// The same for `weft finish`, which derives no map.
struct FinishRequest : MapsRequest {
  FinishRequest() { recipe = "tile"; }

  GridWish grid;
};
void describe(Fields& fields, FinishRequest& request);

}  // namespace weft::material
