// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/accuracy/accuracy_scenes.h"
#include "bench/base/solved_maps.h"
#include "bench/base/study.h"
#include "core/base/result.h"
#include "solve/levels/frame.h"
#include "solve/levels/stage.h"
#include "solver/method.h"

namespace weft::bench {

/// A way from a patch's readings to its maps, on so many threads.
using SolvePatch = std::function<Result<void>(const ClothPatch& patch, int threads, SolvedMaps& maps)>;

struct Contender {
  std::string name;
  SolvePatch solve;
  bool is_quality = false;    ///< a level
  bool is_yardstick = false;  ///< knows what no scan knows: not compared by price
  int planes = 1;             ///< of its readings
};

/// Every level and method of the solver, and last `oracle`: least squares on the readings of the LEDs that
/// the simulator knows each point to face and see.
std::vector<Contender> contenders();
/// Those with these names, and the yardsticks; all where there are no names. kUsage for a name that is not
/// there.
Result<std::vector<Contender>> contenders_named(const std::vector<std::string>& names);

/// The levels, from the cheapest.
std::vector<std::string> level_names();

/// By stages on a patch of its own size.
SolvePatch by_stages(std::vector<solve::Stage> stages);
/// Photographs by a level, as the product runs it on a frame of its own size.
Result<solve::FrameFacts> solve_level(const solve::Photographs& photographs, const solver::MethodName& level,
                                      int threads, SolvedMaps& maps);
/// A level as the product runs it on a frame: from counts to maps. Each pixel of a preview stands for the
/// four photosites that it was made of.
SolvePatch by_level(const solver::MethodName& level);
/// A method as the product runs it: on the mosaic, or after demosaicing where that is what it wants.
SolvePatch as_product(std::shared_ptr<const solver::Method> method);

/// A method over whole images in the tiles of `weft solve`; `readings` holds `maps.planes` views a light.
/// Three planes are weighed as `plane_weights` say.
Result<void> solve_images(const solver::Method& method, const std::vector<View<const float>>& readings,
                          const LightField& field, const CfaPattern& cfa,
                          const std::optional<NoiseModel>& noise, int threads, SolvedMaps& maps,
                          const std::array<double, 3>& plane_weights = solver::kLuminance);

std::vector<View<const float>> planes_of(const Image<float>& readings);

Error no_such(const char* what, const std::string& name, const std::vector<std::string>& names);

/// The patches of a scene with the Cramer-Rao bound of each pixel: rms degrees for the lights that the point
/// faces and sees.
struct BoundedPatches {
  std::vector<ClothPatch> patches;
  std::vector<Image<float>> bounds;
};
BoundedPatches with_bounds(std::vector<ClothPatch> patches, int threads);

/// Errors and time of one contender on the patches of one scene, as accuracy_table() describes them, without
/// what compares it with others.
Result<Json> score(const Contender& contender, const BoundedPatches& scene, int threads);

/// The mean of rows that belong together: of every number that is no integer.
Json mean_row(const std::vector<const Json*>& rows);

double number(const Json& row, const char* key);

}  // namespace weft::bench
