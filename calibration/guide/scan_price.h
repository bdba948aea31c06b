// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "calibration/guide/known_rig.h"
#include "calibration/guide/planned_cloth.h"
#include "capture/scan/scan_plan.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/rig/session.h"

// What more lights, repeats, brackets and films buy of a scan, and what they cost, before one photograph.

namespace weft::calibration {

/// What a shot costs, by a scan that there was.
struct ShotCost {
  double shot_s = 0;      ///< median from shot to shot, the exposure in it
  double exposure_s = 0;  ///< of its lit shots
  double bytes = 0;       ///< mean of its lit frames
};
/// None where under three shots of the session say when they were taken.
std::optional<ShotCost> shot_cost_of(const Session& session);

/// One way to photograph the cloth.
struct ShotsPrice {
  capture::ShotList list;
  std::string what;  ///< "10 LEDs, repeat, bracket x16"
  int shots = 0;
  std::optional<double> seconds, bytes;  ///< none: no scan of this rig has told
  /// Standard deviation of a normal, mean over what is told, degrees: light and sensor, how well the LEDs are
  /// known, and their fading by kUnseenFade where no repeat sees it. None: nobody knows where the LEDs are,
  /// or the normals of under half of the cloth are told.
  std::optional<double> light_deg;
  /// Mean error of cloths by so many LEDs, their shadows and gloss in it: docs/measured/accuracy.md, fewer
  /// LEDs, standard.
  double cloth_deg = 0;
  std::optional<double> predicted_deg;  ///< both
  double solved = 0;                    ///< share of the cloth's normals that the lights tell
  bool is_asked = false;                ///< as the request has it
  bool is_chosen = false;               ///< the one to buy

  std::optional<double> of_whole_deg() const;
};
void describe(Fields& fields, ShotsPrice& price);

/// What is asked of the shots.
struct ShotsWish {
  std::optional<double> to_deg, within_s;

  bool is_one() const { return to_deg || within_s; }
};

struct ScanPrices {
  std::string cloth;  ///< of planned_cloths(): what the cloth is taken to be like
  std::vector<ShotsPrice>
      rows;  ///< what is asked for, and all that nothing cheaper is as good as; dearer last
  std::vector<std::string> notes;
};
void describe(Fields& fields, ScanPrices& prices);

struct ScanPriceOptions {
  capture::ShotList asked;       ///< its LEDs are those that may be lit
  NamedCloth cloth;              ///< what the cloth is taken to be like
  std::optional<ShotCost> cost;  ///< none: no scan has told
  bool may_bracket = true;       ///< the calibration measured ratios of exposures
  bool has_two_films = false;    ///< the board turns a film
  ShotsWish wish = {};
};

/// Prices lists of three LEDs to all that are asked for, without and with a repeat, a bracket of the asked
/// ratio, else of kUsualBracket, and both films. Of so many LEDs those that tell most. `rig` is none where
/// nobody knows its lights: the list that is asked for is then counted and nothing is foretold.
///
/// The chosen one is the cheapest that is as close as `to_deg` and as quick as `within_s`; with `within_s`
/// alone, and with no wish at all, the cheapest that is at most kNothingToGain worse than the best that is
/// quick enough, and of such ones so by light_deg too, which tilts a whole cloth. kUsage with what is
/// possible where none is.
Result<ScanPrices> price_scan(const std::optional<solver::ForeseenRig>& rig, const ScanPriceOptions& options);

/// The share by which docs/conditions.md lets LEDs fade, and the bracket that it has for dark cloth.
inline constexpr double kUnseenFade = 0.05, kUsualBracket = 16;
inline constexpr double kNothingToGain = 0.05;

}  // namespace weft::calibration
