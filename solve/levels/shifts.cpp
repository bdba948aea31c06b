// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/shifts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/base/parallel.h"
#include "solve/levels/frame.h"
#include "solve/photographs/cut.h"
#include "solve/photographs/tile_reader.h"
#include "solver/registration/far_shifts.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
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

constexpr int kFarSide = 256;                          // pixels a side that are searched
constexpr std::array<int, 2> kFarParts = {512, 2048};  // pixels a side of the frame, one after the other

// Shifts of so many photographs are found in moments; photographs that are developed are copied as they are
// cut.
constexpr std::size_t kMostFarShots = 64;
constexpr double kMostCopied_bytes = 512e6;

int most_copied_px(std::size_t shots) {
  constexpr double kPixel_bytes = 3 * sizeof(float);
  return static_cast<int>(std::sqrt(kMostCopied_bytes / kPixel_bytes / static_cast<double>(shots)));
}

// The middle of a frame, on whole cells of the colour filter.
Rect middle_of(Size size, int side) {
  const Size part = {std::min(size.width, side), std::min(size.height, side)};
  const int x0 = (size.width - part.width) / 4 * 2, y0 = (size.height - part.height) / 4 * 2;
  return {x0, y0, x0 + part.width, y0 + part.height};
}

// Green readings over strength of developed photographs, a picture a light.
std::vector<Image<float>> greens_of(const Photographs& photographs) {
  std::vector<Image<float>> greens;
  const Size size = photographs.size;
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    Image<float> unused;
    const auto readings = readings_of(photographs.frames, k, {0, 0, size.width, size.height}, unused.plane());
    Image<float> green(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double strength = photographs.field->at(k, 1, x, y).strength;
        green(x, y) = strength > 0 ? static_cast<float>(static_cast<double>(readings[1](x, y)) / strength)
                                   : std::numeric_limits<float>::quiet_NaN();
      }
    }
    greens.push_back(std::move(green));
  }
  return greens;
}

std::vector<Vec3> lights_in_the_middle(const Photographs& photographs) {
  std::vector<Vec3> lights;
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    lights.push_back(
        photographs.field->at(k, 1, photographs.size.width / 2, photographs.size.height / 2).direction);
  }
  return lights;
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

Result<MovedShots> find_far_shifts(const Photographs& photographs, const JobContext& context) {
  MovedShots result;
  if (photographs.count() > kMostFarShots) return result;
  const int longest = std::max(photographs.size.width, photographs.size.height);
  for (const int wanted : kFarParts) {
    const int side = photographs.mosaics() ? wanted : std::min(wanted, most_copied_px(photographs.count()));
    Result<Photographs> part = cut(photographs, middle_of(photographs.size, side));
    double pixel_px = 1;
    while (part && (part->mosaics() || std::max(part->size.width, part->size.height) > kFarSide)) {
      part = half_size(*part, context.threads);
      pixel_px *= 2;
    }
    if (!part) return std::move(part).error();
    if (context.stop.stop_requested()) return interrupted();
    const solver::FarShifts found =
        solver::find_far_shifts(greens_of(*part), lights_in_the_middle(*part), context.threads);
    result.reach_px = solver::kFarReach * pixel_px * std::min(part->size.width, part->size.height);
    for (std::size_t k = 0; found.found && k < found.shots.size(); ++k) {
      const double px = pixel_px * std::hypot(found.shots[k].dx_px, found.shots[k].dy_px);
      if (!(px > 0)) continue;
      result.moved.push_back(k);
      result.most_px = std::max(result.most_px, px);
      result.explained = found.explained;
    }
    if (!result.moved.empty() || side >= longest) break;
  }
  return result;
}

}  // namespace weft::solve
