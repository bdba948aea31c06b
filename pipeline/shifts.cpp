// SPDX-License-Identifier: Apache-2.0
#include "pipeline/shifts.h"

#include <memory>
#include <utility>

#include "core/parallel.h"
#include "core/vec.h"
#include "pipeline/tile_reader.h"
#include "solver/method.h"
#include "solver/sample_tiles.h"

namespace weft::app {
namespace {

// The sample tiles of photographs, each with readings of its own.
class Samples {
 public:
  explicit Samples(const Photographs& photographs) {
    const TileOptions size = {.width = solver::kSampleTile, .height = solver::kSampleTile};
    const bool mosaics = photographs.rgb.empty();
    const std::vector<Rect> tiles = solver::sample_tiles(photographs.size);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      readers_.push_back(std::make_unique<TileReader>(photographs, size, 0, false));
      inputs_.push_back({tiles[i], mosaics ? 1 : 3, mosaics ? photographs.radiometry->cfa() : CfaPattern{},
                         readers_.back()->read(tiles[i]), &*photographs.field,
                         mosaics ? photographs.noise : std::nullopt});
    }
  }
  const std::vector<solver::TileInput>& inputs() const { return inputs_; }

 private:
  std::vector<std::unique_ptr<TileReader>> readers_;
  std::vector<solver::TileInput> inputs_;
};

// Residual of `fast`, rms over the albedo: mean over the pixels that have a solution.
double residual_of(const std::vector<solver::TileInput>& inputs, int threads) {
  const std::unique_ptr<solver::Method> method = solver::fast_method();
  std::vector<double> sums(inputs.size()), counts(inputs.size());
  parallel_for(inputs.size(), threads, [&](std::size_t i, int) {
    const Size size = {inputs[i].tile.width(), inputs[i].tile.height()};
    Image<float> maps(size, 11);
    Image<std::uint16_t> status(size);
    const auto three = [&](int first) {
      return std::array{maps.plane(first), maps.plane(first + 1), maps.plane(first + 2)};
    };
    solver::TileOutput output;
    output.normal = three(0);
    output.albedo = three(3);
    output.sigma_albedo = three(6);
    output.sigma_normal_deg = maps.plane(9);
    output.residual = maps.plane(10);
    output.status = status.plane();
    method->solve(inputs[i], output);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (status(x, y) & (kNoSolution | kInvalidReading)) continue;
        sums[i] += double{maps(x, y, 10)};
        ++counts[i];
      }
    }
  });
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sum += sums[i];
    count += counts[i];
  }
  return count > 0 ? sum / count : 0;
}

bool worth_it(const ShotShift& shot) {
  return shot.measured.significant && shot.measured.cost_deg > kLeastCost_deg;
}

const char* name_of(const ShotShift& shot, bool found) {
  if (!found) return "not registered";
  if (shot.verdict == ShiftVerdict::kCorrected) return "corrected";
  return shot.verdict == ShiftVerdict::kFlagged ? "flagged" : "still";
}

}  // namespace

Result<SessionShifts> register_shots(Photographs& photographs, const JobContext& context) {
  photographs.shifts.clear();
  const int threads = resolved_threads(context.threads);
  double residual = 0;
  SessionShifts result;
  {
    const Samples samples(photographs);
    solver::Registration measured = solver::register_shots(samples.inputs(), photographs.size, threads);
    result.found = measured.found;
    for (const solver::ShotRegistration& shot : measured.shots) result.shots.push_back({shot});
    residual = residual_of(samples.inputs(), threads);
  }
  if (context.stop.stop_requested()) return interrupted();
  bool any = false;
  std::vector<solver::ClothShift> shifts;
  for (ShotShift& shot : result.shots) {
    if (worth_it(shot)) shot.verdict = ShiftVerdict::kFlagged;
    any |= worth_it(shot);
    shifts.push_back(worth_it(shot) ? shot.measured.shift : solver::ClothShift());
  }
  if (!any || !result.found) return result;

  photographs.shifts = std::move(shifts);
  if (residual_of(Samples(photographs).inputs(), threads) > (1 - kLeastGain) * residual) {
    photographs.shifts.clear();
    return result;
  }
  for (ShotShift& shot : result.shots) {
    if (worth_it(shot)) shot.verdict = ShiftVerdict::kCorrected;
  }
  return result;
}

Json registration_document(const SessionShifts& shifts, const std::vector<int>& leds) {
  Json list = Json::array();
  for (std::size_t k = 0; k < shifts.shots.size(); ++k) {
    const ShotShift& shot = shifts.shots[k];
    const solver::ShotRegistration& m = shot.measured;
    list.push_back({{"led", k < leds.size() ? leds[k] : static_cast<int>(k) + 1},
                    {"dx_px", m.shift.dx_px},
                    {"dy_px", m.shift.dy_px},
                    {"turn_deg", degrees(m.shift.turn)},
                    {"sigma_px", m.sigma_px},
                    {"cost_deg", m.cost_deg},
                    {"corrected", shot.verdict == ShiftVerdict::kCorrected},
                    {"verdict", name_of(shot, shifts.found)}});
  }
  return list;
}

}  // namespace weft::app
