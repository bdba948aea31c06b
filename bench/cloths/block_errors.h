// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solve/run/solve_session.h"
#include "solver/uncertainty/block_facts.h"

namespace weft::bench {

/// Whose blocks they are.
struct BlocksOf {
  std::string cloth;
  std::uint32_t seed = 0;
  std::string quality;
  bool of_session = false;
};

/// What a block of a solve showed, and what came of it: the mean error of its normals, and mean squares of
/// the parts of sigma beside the model's, degrees.
struct BlockError {
  std::string solve, quality;  ///< by cloth, seed and level
  solver::BlockFacts facts = {};
  double error_deg = 0, other2 = 0;
  double pixels = 0;
  double weight = 0;  ///< pixels over those of all blocks of the same solve
};

/// Pixels near the frame's border do not count: the solver cannot know the cloth beyond.
inline constexpr int kUncountedEdge = 12;

/// Adds a line for each block with enough pixels: {"cloth", "seed", "quality", "session", "facts", "error",
/// "other2", "pixels"}.
Result<void> append_blocks(const BlocksOf& whose, const solve::SolveReport& solved, const Image<float>& truth,
                           const std::filesystem::path& file);

/// The blocks of a file of such lines. Errors: as read_text(); kBadData where a line is none.
Result<std::vector<BlockError>> read_blocks(const std::filesystem::path& file);

}  // namespace weft::bench
