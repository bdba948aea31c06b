// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/base/study.h"
#include "bench/cloths/drawn_kinds.h"
#include "core/base/result.h"

namespace weft::bench {

struct ClothsOptions {
  KindSet set = KindSet::kHeldOut;
  std::string kind;                  ///< one alone; empty: all of the set
  std::vector<std::string> methods;  ///< levels; empty: all five
  bool as_session = false;  ///< mosaics of a calibrated rig; else loose photographs of relative scale
  std::filesystem::path blocks = {};  ///< file that gets a line for each block of each solve, if there is one
};

/// Kinds of cloth, drawn `runs` times each, written as photographs or sessions and solved as the product
/// solves them: a row for each drawing and level.
/// true_deg: mean error of normal.exr. foretold_deg: what the report lets one expect, and their ratio.
/// over_sigma: median of error over sigma.exr's normal_deg; beyond_3: share beyond three of it. spreads:
/// share of the light that leaves elsewhere, and told: of what was taken off. said: names of the warnings.
Result<Rows> cloths_table(const ClothsOptions& asked, const StudyOptions& options);

}  // namespace weft::bench
