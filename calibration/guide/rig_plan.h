// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/guide/planned_cloth.h"
#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "solver/light_plan/best_place.h"

namespace weft::calibration {

struct RigPlanOptions {
  std::filesystem::path rig;  ///< a rig file, or the folder of a calibration
  NamedCloth cloth;
  solver::LightAim aim = solver::LightAim::kAll;
  double seconds_a_shot = 4;
};

/// What one set of lights tells, and what it costs beside the lights that there are.
struct RigPlanRow {
  /// For programs: as-it-is, one-more, near-camera, polarisers, polarisers-near-camera, moved.
  std::string name;
  std::string what;             ///< for people
  solver::ForeseenSigma sigma;  ///< of a solve, which takes the rig to be as it was calibrated
  solver::ForeseenSigma least;  ///< of the best estimate there is, which fits the rig's errors with the cloth
  std::optional<solver::LedPlace> place = {};  ///< of the LED that is new or moved
  std::optional<std::size_t> moved = {};       ///< its number, from 1
  int extra_shots = 0;
  double extra_seconds = 0;  ///< a scan
  double degrees_won = 0;    ///< of the normal; below 0: lost
};

struct RigPlan {
  std::string rig;
  solver::ForeseenRig planned;
  bool is_calibrated = false;  ///< how far its LEDs may be off is the calibration's own, not what is typical
  NamedCloth cloth;
  std::vector<RigPlanRow> rows;           ///< the first is as it is
  std::vector<solver::TriedPlace> tried;  ///< one more LED, all over the hemisphere
  std::string verdict;                    ///< whether the lobe is observable, or what makes it so
  std::vector<std::string> notes;
};

/// What the LEDs of a rig tell of a cloth, and what one more, one moved or films before them would. kBadData
/// where the rig's lights have no places.
Result<RigPlan> plan_rig(const RigPlanOptions& options, const JobContext& context);

/// docs/calibration.md. What is not told is null.
Json json_of(const RigPlan& plan);
/// The hemisphere of places as SVG.
std::string picture_of(const RigPlan& plan);

}  // namespace weft::calibration
