// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "simulator/effects/passes.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"

namespace weft::simulator {

/// What will be simulated, decided before anything is.
struct SimulationPlan {
  Scene scene;  ///< its effects are those that run
  SceneRig rig;
  std::vector<LeftOutEffect> left_out;
};

/// Takes a scene's effects at its word, or with `effects = "auto"` decides them by their bounds. Errors as
/// rig_of().
Result<SimulationPlan> plan_of(const Scene& scene);

/// What is left out, with what each would change at most and why, also where a scene only does not name it;
/// the least first.
std::vector<LeftOutEffect> bounded_left_out(const SimulationPlan& plan);

/// Seconds of one thread that a left-out effect would have cost, from running the centre of the frame with it
/// and without. An effect that could not run there would have cost nothing.
double seconds_saved(const SimulationPlan& plan, const LeftOutEffect& effect);

/// How far off a scene is that is rendered in time.
struct TimelyPlan {
  double to_sigma = 0;  ///< for Scene::auto_to_sigma
  double seconds = 0;   ///< foretold of rendering its photographs, without the truth and without files
};

/// The least tolerance of kAutomaticRange, to 5 percent, at which `scene` is rendered in `within_s`, as the
/// centre of the frame foretells. Errors as plan_of(); kUsage with the quickest where none is; kInterrupted.
Result<TimelyPlan> plan_within(const Scene& scene, double within_s, const JobContext& context);

}  // namespace weft::simulator
