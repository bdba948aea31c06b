// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/rig/session.h"

// What more photographs buy of a calibration, and what they cost, before they are taken.

namespace weft::calibration {

/// A calibration from what there is and some more.
struct PosesPrice {
  int more = 0;      ///< poses that are not there yet
  int poses = 0;     ///< with those that are
  double rig_s = 0;  ///< at the rig for those that are not: a person lays the thing, the rig photographs it
  double fit_s = 0;  ///< of fitting all
  double predicted_deg = 0;  ///< what its errors turn a normal by, rms over the frame
  std::optional<double> focal_percent = {},
                        place_mm = {};     ///< sigma, of a camera (calibration/camera/guidance.h)
  std::optional<double> position_mm = {};  ///< sigma of the LED that is known worst, along its worst axis
  bool is_chosen = false;
};
void describe(Fields& fields, PosesPrice& price);

/// What is asked of a calibration.
struct PosesWish {
  bool only_explains = false;
  std::optional<double> to_deg, within_s;
};
/// --explain, --to and --within of a step.
void describe(Fields& fields, PosesWish& wish);

struct PosesPrices {
  std::string thing;             ///< "board", "sheet": what is laid under the camera
  std::vector<PosesPrice> rows;  ///< fewest first
};
void describe(Fields& fields, PosesPrices& prices);

/// Poses beyond those that are there that are priced.
inline constexpr std::array<int, 5> kMorePoses = {0, 1, 2, 5, 10};
/// A person lays a thing (bench/capture, minutes).
inline constexpr double kLaying_s = 20;
/// More poses that are not so much better have nothing to gain.
inline constexpr double kPosesGain = 0.05;

/// From the first shot of a session to the end of its last; none where its shots do not say when they were
/// taken.
std::optional<double> seconds_taken(const Session& session);

/// Chooses the fewest poses that are as close as `to_deg` and take no longer at the rig than `within_s`;
/// where no degrees are asked for, the fewest that no more of them are over kPosesGain better than. kUsage
/// with what is possible where there are none.
Result<void> choose_poses(PosesPrices& prices, const PosesWish& wish);

}  // namespace weft::calibration
