// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/tiles.h"
#include "solve/bands/bands.h"
#include "solve/correction/light_correction.h"
#include "solve/levels/frame.h"
#include "solve/levels/solved_relief.h"
#include "solve/photographs/photographs.h"
#include "solver/method.h"

// A level of accuracy is a list of stages: each finds a better way to solve the frame than the stages before
// it left, or sends its maps on better than they come, and one of them solves it.

namespace weft::solve {

/// A solve under way: what it is given, and what each stage leaves for those that follow.
struct Solving {
  const Photographs& photographs;
  const TileOptions& tile;
  const JobContext& context;
  BandSink sink;                 ///< takes the bands of the solve
  bool looks_at_blocks = false;  ///< FrameFacts::blocks is wanted
  FrameFacts facts = {};

  const solver::Method* method = nullptr;   ///< by which the frame is solved
  const solver::Method* lambert = nullptr;  ///< the same without lobes, where they have been looked for
  BandOptions bands = {};                   ///< it is solved with them
  /// What the cloth does to its own light, as far as that may be worth taking out of the readings.
  LightStages light = {.shadows = true, .interreflection = true};
  std::shared_ptr<SolvedRelief> relief = {};  ///< readings go through its correction, if there is one
  /// What stood before there was a relief.
  struct Below {
    const solver::Method* method = nullptr;
    std::optional<GlossFacts> gloss;
  } below = {};

  /// Keeps what later stages point to until the solve ends.
  template <typename T>
  T& keep(std::unique_ptr<T> made) {
    std::shared_ptr<T> shared = std::move(made);
    kept.push_back(shared);
    return *shared;
  }
  std::vector<std::shared_ptr<const void>> kept = {};
};

inline bool has_relief(const Solving& s) {
  return s.relief != nullptr;
}

/// What readings are to go through: a new correction by the relief, null where there is none.
inline std::unique_ptr<LightCorrection> correction_by_relief(const Solving& s) {
  return s.relief ? std::make_unique<LightCorrection>(s.relief->correction()) : nullptr;
}

struct Stage {
  std::string name;
  std::string does;                               ///< in one sentence (docs/accuracy.md)
  std::function<bool(const Solving&)> is_needed;  ///< it is passed over where it is not
  std::function<Result<void>(Solving&)> apply;
};

/// Solves a frame by a list that begins with a method's stage (stages.h).
Result<FrameFacts> solve_by(std::span<const Stage> stages, const Photographs& photographs,
                            const TileOptions& tile, const JobContext& context, const BandSink& sink,
                            bool looks_at_blocks = false);

/// The list without the stages of this name.
std::vector<Stage> without(std::string_view name, std::vector<Stage> stages);

}  // namespace weft::solve
