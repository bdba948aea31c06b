// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "solve/input/session_input.h"
#include "solve/run/explain.h"
#include "solve/run/solve_session.h"

namespace weft::solve {

/// One level of a ladder picture.
struct LadderStep {
  std::string quality;
  std::filesystem::path folder;          ///< of its solve
  std::optional<double> error_deg;       ///< mean angle to the truth over the crop, where there is a truth
  std::optional<double> whole_deg = {};  ///< and over the frame
  std::optional<SolvePrice> foretold = {}, taken = {};  ///< as the solve keeps them
};

/// Solves a session by every level, each into its own folder of the session unless it is there already, and
/// draws the normals of the same 128 x 128 pixels in the middle of the frame side by side into the PNG
/// `file`, each twice enlarged with its name and error; last the truth, where there is one. The normal maps
/// are read one after the other, 20 bytes a pixel. `options.method` and `options.output` are not used. Solves
/// keep what `prices` foretold of their levels.
Result<std::vector<LadderStep>> draw_ladder(const SessionOptions& input, const SolveOptions& options,
                                            const std::filesystem::path& file, const JobContext& context,
                                            std::span<const LevelPrice> prices = {});

}  // namespace weft::solve
