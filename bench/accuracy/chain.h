// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/base/report.h"
#include "core/result.h"
#include "simulator/scene/scene.h"

namespace weft::bench {

/// A rig and the cloth on it, with what is not as it should be.
struct ChainCase {
  std::string name;  ///< "plain, blur 0.4 px"
  simulator::Scene scene;
  bool knows_paper =
      true;  ///< else its reflectance is unknown when lights are calibrated: albedo is relative
};

/// The cases: weaves of the accuracy set, 12.5 pixels a yarn, over the rig of `rig` with its lens, its dark
/// corners and its uneven, bent sensor, and one thing more in each. `rig` is testdata/scenes/rig.toml, made
/// smaller: 0.8 megapixels of 200 mm. Other seeds draw other weaves and other noise. Errors: as read_scene.
Result<std::vector<ChainCase>> chain_cases(const std::filesystem::path& rig, std::uint32_t seed);

struct ChainOptions {
  std::filesystem::path rig = "testdata/scenes/rig.toml";  ///< from where the program runs
  std::string name;                                        ///< this case alone; empty: all
  std::vector<std::string> levels;                         ///< these alone; empty: all
  std::uint32_t seed = 1;
  int threads = 0;
};

/// Every case by the product's own steps: captures are simulated as a rig takes them, `weft calibrate` makes
/// a calibration of camera, response and lights from them, a session is photographed, and `weft solve` makes
/// its maps: conditions, registration, levels. A row a case and level:
/// mean_deg, p95_deg: angle of the published normals to the truth. exact_deg: the mean by the same level with
/// the calibration that the simulator knows, which is what is left when nothing has to be measured.
/// albedo_rel: mean of |A - B| / B, of a relative scale once the medians agree. seconds: of the whole solve.
/// kUsage where no case or level has the given name. About 300 MB of disk, and a minute a case.
Result<Rows> chain_table(const ChainOptions& options);

}  // namespace weft::bench
