// SPDX-License-Identifier: Apache-2.0
#include "pipeline/shifts.h"

#include <algorithm>
#include <memory>

#include "core/parallel.h"
#include "pipeline/tile_reader.h"
#include "solver/sample_tiles.h"

namespace weft::pipeline {
namespace {

// The sample tiles of photographs, each with readings of its own.
class Samples {
 public:
  explicit Samples(const Photographs& photographs) {
    const TileOptions size = {.width = solver::kSampleTile, .height = solver::kSampleTile};
    for (const Rect& tile : solver::sample_tiles(photographs.size)) {
      readers_.push_back(std::make_unique<TileReader>(photographs, size));
      inputs_.push_back(readers_.back()->read(tile));
    }
  }
  const std::vector<solver::TileInput>& inputs() const { return inputs_; }

 private:
  std::vector<std::unique_ptr<TileReader>> readers_;
  std::vector<solver::TileInput> inputs_;
};

bool has_moved(const solver::ShotRegistration& shot) {
  return shot.significant && shot.cost_deg > kLeastCost_deg;
}

}  // namespace

std::vector<std::size_t> SessionShifts::with(ShiftVerdict verdict) const {
  std::vector<std::size_t> lights;
  for (std::size_t k = 0; k < shots.size(); ++k) {
    if (shots[k].verdict == verdict) lights.push_back(k);
  }
  return lights;
}

Result<SessionShifts> register_shots(const Photographs& photographs, const JobContext& context) {
  const solver::Registration measured = solver::register_shots(
      Samples(photographs).inputs(), photographs.size, resolved_threads(context.threads));
  if (context.stop.stop_requested()) return interrupted();
  const auto moved = static_cast<std::size_t>(std::ranges::count_if(measured.shots, has_moved));
  const std::size_t still = measured.shots.size() - moved;
  const bool can_do_without = measured.found && still >= kLeastStillShots && still > moved;
  SessionShifts result = {{}, measured.found};
  for (const solver::ShotRegistration& shot : measured.shots) {
    const ShiftVerdict verdict = can_do_without ? ShiftVerdict::kLeftOut : ShiftVerdict::kFlagged;
    result.shots.push_back({shot, has_moved(shot) ? verdict : ShiftVerdict::kStill});
  }
  return result;
}

}  // namespace weft::pipeline
