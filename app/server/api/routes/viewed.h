// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/server/api/api.h"
#include "app/server/view/probes.h"
#include "app/server/view/viewed_maps.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"

// Maps that are looked at: those of a solve, the truth of a simulated session, a set that weft maps made.

namespace weft::app {

/// Stands for a solve where the session is simulated.
inline constexpr const char* kTruth = "truth";

/// The maps that a call asks about.
struct Viewed {
  Session session;
  std::filesystem::path folder;
  std::string id;
  std::string content;        ///< names their bytes
  std::string document = {};  ///< its file in the folder; empty: the truth's, which has none
  std::optional<SolveFacts>
      solve;  ///< that they are, or that a set was made of; none: the truth, or one that is gone
  std::optional<Json> set;  ///< maps.json of a set of maps, material.json of what was built of a material
  bool is_build = false;    ///< the set is that of a material, and has no session
  double mm_per_pixel = 0;  ///< of a set
  Layers layers;

  bool is_solve() const { return solve && !set; }
};

/// Where the sets of maps of a session lie.
std::filesystem::path map_sets_of(const Session& session);

/// Finds maps of a session by their id. kUsage, kNoInput; kBadData where their document or a file cannot be
/// read.
using FindMaps = Result<Viewed> (*)(const RigParts& parts, const std::string& session, const std::string& id);
Result<Viewed> find_solve_maps(const RigParts& parts, const std::string& session, const std::string& id);
Result<Viewed> find_map_set(const RigParts& parts, const std::string& session, const std::string& id);
/// Likewise what was built of the material that has this key (library_materials.h).
Result<Viewed> find_built_maps(const RigParts& parts, const std::string& material, const std::string& id);

/// A layer of the maps. kNoInput where they have none of this name; errors of Pyramid::open().
Result<std::shared_ptr<Pyramid>> pyramid_of(const RigParts& parts, const Viewed& viewed,
                                            const std::string& layer);

/// Whether nobody knows how bright they are.
bool has_relative_albedo(const Viewed& viewed);
/// What their albedo is multiplied by to be looked at: 1 where it has an absolute scale.
Result<double> gain_of(const RigParts& parts, const Viewed& viewed);

/// How the maps lie on the cloth.
struct Lying {
  std::optional<Calibration>
      calibration;  ///< with a camera, as the cloth sees it; none: maps on a grid of the table
  Ground ground(const Viewed& viewed) const;
};
/// kBadData where nobody calibrated the camera.
Result<Lying> lying_of(const Viewed& viewed);

/// At the middle of the frame; 0 where nobody knows.
double mm_per_pixel_of(const Viewed& viewed);

/// The square of them that stands for the cloth (app/server/view/swatch.h). Errors of Pyramid::open() and
/// read().
Result<Rect> swatch_part_of(const RigParts& parts, const Viewed& viewed);

/// The names of what a list of a document has: its maps, its verdicts.
Json names_in(const Json& document, const char* key);

/// When the document of a folder was written, ISO 8601: maps carry no dates.
std::string written_at(const std::filesystem::path& document);

/// What a viewer has to know of them: ViewedSolve of solves.openapi.json.
Result<Json> viewed_json(const RigParts& parts, const Viewed& viewed);

/// Tiles, a pixel, a region and a line of the maps below the path `one`, whose segments are session and id.
std::vector<Route> view_routes(const RigParts& parts, const std::string& one, FindMaps find);

}  // namespace weft::app
