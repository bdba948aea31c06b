// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/product.h"
#include "core/base/result.h"
#include "core/image/compression.h"
#include "material/run/derived_maps.h"
#include "material/run/map_set_facts.h"
#include "material/run/recipe.h"
#include "material/run/rectify.h"

namespace weft::material {

struct MapsOptions {
  std::filesystem::path session;      ///< or the folder of a solve of photographs
  std::string solve;                  ///< id of the solve; empty: the session's current one
  bool is_draft = false;              ///< a preview will do
  std::filesystem::path calibration;  ///< empty: the session's own
  std::filesystem::path output;       ///< empty: <session>/maps/<id>
  Recipe recipe;                      ///< no step: the maps as they were photographed
  std::vector<std::string> maps;      ///< to derive (derived_maps()); none: those of the surface alone
  DeriveOptions derive;
  std::filesystem::path bare;  ///< session of the bare table by the light below; empty: there is none
  /// R, G, B of the table, 0 to 1, which rims of holes hold a share of: it is taken out. Wants `bare`; none:
  /// it stays.
  std::vector<double> table_albedo;
  std::optional<double> mm_per_pixel = {};  ///< of the grid; none: what the camera sees
  bool is_preview = false;                  ///< of a part of about kPreviewPixels; earlier previews go
  Compression compression = Compression::kNone;
};

inline constexpr std::int64_t kPreviewPixels = 1024 * 1024;

/// What making maps left behind.
struct MapsReport {
  std::filesystem::path folder;
  bool was_there = false;  ///< a complete one of the same solve, recipe and options was found
  MapSetFacts facts;       ///< with what is stale of the solve today
};

/// The maps of the solve on the grid that is asked for. Errors of rectify_session().
Result<RectifyReport> rectified_maps(const MapsOptions& options, const JobContext& context);

/// Puts the maps of a solve on a square grid of the table (rectify_session()), finishes them by the recipe,
/// derives others, and publishes all of it whole in a folder named by its inputs, with maps.json
/// (weft.maps/1), pictures and report.html (docs/maps.md).
///
/// Errors: those of rectify_session(), of finish_surface() and of each map; kUsage for a table's albedo
/// without `bare` or out of range; kInterrupted.
Result<MapsReport> make_maps(const MapsOptions& options, const JobContext& context);

}  // namespace weft::material
