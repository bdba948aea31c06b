// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "solver/light_plan/light_plan.h"

namespace weft::solver {

/// What is to be known as closely as possible. kAll: the product of the three.
enum class LightAim { kAll, kNormal, kAlpha, kF0 };
inline constexpr std::array<const char*, 4> kPlanAimNames = {"all", "normal", "alpha", "f0"};

/// The log of what is aimed at: less is better; infinite where it is not told.
double badness(const ForeseenSigma& sigma, const Lobe& lobe, LightAim aim);

/// Where a LED may stand: nearer to the camera's axis it would be before the lens. Further off it would light
/// the tops of yarns alone; such shadows are not in a plan.
inline constexpr double kNearestPlace_deg = 8, kFarthestPlace_deg = 64;
/// Two LEDs do not stand in one place.
inline constexpr double kApart_deg = 4;

struct TriedPlace {
  LedPlace place;
  ForeseenSigma sigma;
  std::optional<std::size_t> moved = {};  ///< LED of the rig that was taken away, from 0
};

/// Rings of places every seven degrees, but those where a LED stands.
std::vector<LedPlace> free_places(const ForeseenRig& rig);

/// One more LED in each of these places, beside all that there are.
Result<std::vector<TriedPlace>> try_places(const LightPlan& plan, const LightSet& lights,
                                           const std::vector<LedPlace>& places, const JobContext& context);

/// The best of `tried`, moved on by steps down to a degree. None where none tells the aim.
Result<std::optional<TriedPlace>> best_place(const LightPlan& plan, const LightSet& lights,
                                             const std::vector<TriedPlace>& tried, LightAim aim,
                                             const JobContext& context);

/// The best place for one of the LEDs that there are. None where none tells the aim.
Result<std::optional<TriedPlace>> best_move(const LightPlan& plan, const std::vector<LedPlace>& places,
                                            LightAim aim, const JobContext& context);

}  // namespace weft::solver
