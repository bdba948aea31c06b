// SPDX-License-Identifier: Apache-2.0
#include "solver/light_plan/best_place.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "core/base/parallel.h"

namespace weft::solver {
namespace {

constexpr double kRing_deg = 7, kAlongRing_deg = 12;
// Stride among the places that one more LED is tried in, for each LED that is moved.
constexpr std::size_t kMoveStride = 2;
constexpr double kFirstStep_deg = 4, kLastStep_deg = 1;

bool is_free(const ForeseenRig& rig, LedPlace place) {
  const Vec3 middle = rig.places_mm.front(), l = led_at(rig, place).position_mm - middle;
  return std::ranges::none_of(
      rig.leds, [&](const NearLight& led) { return angle_deg(led.position_mm - middle, l) < kApart_deg; });
}

// The first of the best.
std::optional<TriedPlace> best_of(const std::vector<TriedPlace>& tried, const Lobe& lobe, LightAim aim) {
  std::optional<TriedPlace> best;
  double least = std::numeric_limits<double>::infinity();
  for (const TriedPlace& each : tried) {
    const double bad = badness(each.sigma, lobe, aim);
    if (!(bad < least)) continue;
    least = bad;
    best = each;
  }
  return best;
}

// Those around a place, a step away, that are free.
std::vector<LedPlace> around(const ForeseenRig& rig, LedPlace place, double step_deg) {
  std::vector<LedPlace> places;
  const double along = step_deg / std::sin(radians(place.from_camera_deg));
  for (const double out : {-step_deg, 0.0, step_deg}) {
    for (const double aside : {-along, 0.0, along}) {
      const LedPlace next = {std::clamp(place.from_camera_deg + out, kNearestPlace_deg, kFarthestPlace_deg),
                             std::fmod(place.azimuth_deg + aside + 360, 360)};
      if (next != place && is_free(rig, next)) places.push_back(next);
    }
  }
  return places;
}

// Tries all places; `try_at` writes what comes of number i.
Result<void> for_places(std::size_t count, const JobContext& context,
                        const std::function<void(std::size_t)>& try_at) {
  parallel_for(count, context.threads, [&](std::size_t i, int) {
    if (!context.stop.stop_requested()) try_at(i);
  });
  if (context.stop.stop_requested()) return interrupted();
  return {};
}

}  // namespace

double badness(const ForeseenSigma& sigma, const Lobe& lobe, LightAim aim) {
  const double normal = std::log(sigma.normal_deg) + std::log1p(sigma.unsolved);
  if (aim == LightAim::kNormal) return normal;
  if (aim == LightAim::kAlpha) return std::log(sigma.alpha);
  if (aim == LightAim::kF0) return std::log(sigma.f0);
  return lobe.shines() ? normal + std::log(sigma.alpha) + std::log(sigma.f0) : normal;
}

std::vector<LedPlace> free_places(const ForeseenRig& rig) {
  std::vector<LedPlace> places;
  for (double from_camera = kNearestPlace_deg; from_camera <= kFarthestPlace_deg; from_camera += kRing_deg) {
    const double around = 360 * std::sin(radians(from_camera)) / kAlongRing_deg;
    const int count = std::max(6, static_cast<int>(std::lround(around)));
    for (int i = 0; i < count; ++i) {
      const LedPlace place = {from_camera, 360.0 * i / count};
      if (is_free(rig, place)) places.push_back(place);
    }
  }
  return places;
}

Result<std::vector<TriedPlace>> try_places(const LightPlan& plan, const LightSet& lights,
                                           const std::vector<LedPlace>& places, const JobContext& context) {
  std::vector<TriedPlace> tried(places.size());
  const Result<void> done = for_places(places.size(), context, [&](std::size_t i) {
    LightSet set = lights;
    set.added = led_at(plan.rig(), places[i]);
    tried[i] = {places[i], plan.sigma_of(set)};
  });
  if (!done) return done.error();
  return tried;
}

Result<std::optional<TriedPlace>> best_place(const LightPlan& plan, const LightSet& lights,
                                             const std::vector<TriedPlace>& tried, LightAim aim,
                                             const JobContext& context) {
  const Lobe& lobe = plan.cloth().lobe;
  std::optional<TriedPlace> best = best_of(tried, lobe, aim);
  for (double step = kFirstStep_deg; best && step >= kLastStep_deg; step /= 2) {
    Result<std::vector<TriedPlace>> near =
        try_places(plan, lights, around(plan.rig(), best->place, step), context);
    if (!near) return std::move(near).error();
    near->push_back(*best);
    best = best_of(*near, lobe, aim);
  }
  return best;
}

Result<std::optional<TriedPlace>> best_move(const LightPlan& plan, const std::vector<LedPlace>& places,
                                            LightAim aim, const JobContext& context) {
  const std::size_t count = (places.size() + kMoveStride - 1) / kMoveStride;
  std::vector<std::vector<ForeseenSigma>> by_place(count);
  const Result<void> done = for_places(count, context, [&](std::size_t i) {
    by_place[i] = plan.moved_to(led_at(plan.rig(), places[kMoveStride * i]));
  });
  if (!done) return done.error();
  std::vector<TriedPlace> tried;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < by_place[i].size(); ++k)
      tried.push_back({places[kMoveStride * i], by_place[i][k], k});
  }
  const std::optional<TriedPlace> first = best_of(tried, plan.cloth().lobe, aim);
  if (!first) return first;
  LightSet others = plan.as_it_is();
  others.leds.erase(others.leds.begin() + static_cast<std::ptrdiff_t>(*first->moved));
  Result<std::optional<TriedPlace>> best = best_place(plan, others, {*first}, aim, context);
  if (best && *best) (*best)->moved = first->moved;
  return best;
}

}  // namespace weft::solver
