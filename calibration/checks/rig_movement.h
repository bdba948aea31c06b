// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calibration/camera/markers.h"
#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/rig/calibration.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"

namespace weft::calibration {

// Whether a rig is still the one that was calibrated, from what every scan shows beside its cloth. Each thing
// that may have happened is a hypothesis with parameters of its own; it is fitted by generalized least
// squares, whose covariance holds what the calibration itself does not know, and judged by Schwarz's
// criterion (BIC; Annals of Statistics 1978) and by how many things of its kind might have happened. The best
// one is taken as a fact and the next one looked for, until none explains enough. What nothing explains
// counts as noise.
//
// What each piece of evidence can tell:
// - tags and fixed points: where the camera is to the table, and nothing of LEDs;
// - patches on the table: whether the camera moved or the table. LEDs light them differently after the table
//   moved, and alike after the camera did;
// - one patch: how bright each LED is. Several in different places tell a LED that moved from one that faded;
// - a sheet, which is seen through the camera: without tags on the table, that the camera moved to the LEDs,
//   never that the table did.

/// A small white place that every LED lights.
struct LitPlace {
  Vec3 point_mm;  ///< rig frame, by the calibration
  Vec3 normal = {0, 0, 1};
  bool on_table = true;       ///< a patch there; else of a sheet, whose place was measured through the camera
  double x_px = 0, y_px = 0;  ///< where it was read
  int surface = 0;            ///< places of one surface share what is unknown of its reflectance
  double reflectance_sigma = 0;  ///< of the surface's reflectance, relative
  std::array<double, 3> reflectance_rgb = {1, 1, 1};
  double delta = 0;  ///< it reflects 1 - delta (1 - n . l) of Lambert's law; 0: MovementOptions::paper_delta
  std::vector<std::array<double, 3>> reading_rgb;  ///< by LED; what is not a positive number is not used
  double reading_sigma = 0;  ///< of each, relative: what few pixels leave of noise and grain
};

/// A point that stays on the table, and where it is seen.
struct PlacedPoint {
  Vec3 point_mm;  ///< rig frame, by the calibration
  PixelPoint seen_px;
  double sigma_px = 0;  ///< of both, beside MovementOptions::corner_sigma_px
};

struct RigEvidence {
  std::vector<TagSighting> tags;
  std::vector<LitPlace> places;
  std::vector<PlacedPoint> points = {};
};

/// Standard deviations of what changes from one session to the next though nothing moved, and what it takes
/// to say that something did.
struct MovementOptions {
  double corner_sigma_px = 0.1;   ///< of tags' corners and fixed points
  double flicker = 0.003;         ///< of a LED's brightness, relative
  double reading_sigma = 0.0002;  ///< of a place's mean reading, relative
  double few_pixels = 1;          ///< times LitPlace::reading_sigma, which adds to that
  double tilt_sigma_deg = 0.1;    ///< of a place against its normal: paper is not flat
  double paper_delta = 0;         ///< LitPlace::delta of places that have none
  double least_evidence = 6;      ///< by which BIC must fall: strong (Kass and Raftery, JASA 1995)
  int most_changes = 4;
};

enum class ChangeKind {
  kCamera,    ///< turned and shifted
  kTable,     ///< turned and shifted, with what lies on it
  kLedMoved,  ///< shifted
  kLedFaded,  ///< brighter or darker
  kLedsSwapped,
  kAllFaded,  ///< all LEDs alike: brightness, exposure or aperture
};

/// One thing that happened. Turns and shifts are in the rig frame: of the camera about its centre, of the
/// table about its own; `sigma` are standard deviations.
struct RigChange {
  ChangeKind kind = ChangeKind::kCamera;
  int led = 0, other_led = 0;  ///< from 1
  Vec3 turn_deg = {}, turn_sigma_deg = {};
  Vec3 shift_mm = {}, shift_sigma_mm = {};
  double factor = 1, factor_sigma = 0;  ///< of brightness
  double evidence = 0;                  ///< by how much BIC fell
  /// What would explain the same evidence nearly as well (BIC within least_evidence of this one's), without
  /// numbers.
  std::vector<RigChange> alternatives = {};
};

struct Movement {
  std::vector<RigChange> changes;  ///< in the order they were found, numbers of all of them together
  double chi_square_before = 0;    ///< per observation, as calibrated
  double chi_square_after = 0;     ///< with the changes
  int corners = 0;                 ///< of tags, in the evidence
  int points = 0;                  ///< fixed ones
  int readings = 0;
  /// The rig as it is now, in the frame of its table.
  CameraModel camera;
  NearLights lights;
  /// Has the parameters of LEDs that changed, named as in ParameterCovariance.
  ParameterCovariance covariance;
};

/// From this chi_square_after on, what is seen contradicts the calibration in a way that no change explains:
/// a patch is covered, a tag was laid elsewhere.
inline constexpr double kUnexplainedFrom = 5;
/// From this one on it is explained worse than usual: a rig that stood still is below 1.5.
inline constexpr double kDoubtfulFrom = 2;

/// Errors: kBadData where there is no evidence: neither a tag of `calibration.fiducials`, nor a point, nor a
/// reading; or where the calibration has no camera or no near lights.
Result<Movement> find_movement(const Calibration& calibration, const RigEvidence& evidence,
                               const MovementOptions& options = {});

/// What scanning with a calibration of `before` costs on a rig that is `after` it: the angle in degrees
/// between what is solved and what is there, for surfaces that lie flat and that slope by 20 degrees towards
/// four sides, over 5 x 3 places of the frame, noise-free.
struct MovementCost {
  double mean_deg = 0;
  double worst_deg = 0;
  double albedo_factor = 1;      ///< mean of solved over true albedo, where it lies flat
  double albedo_unevenness = 0;  ///< largest departure from that over the frame, relative
};
MovementCost cost_of(const CameraModel& camera_before, const NearLights& lights_before,
                     const CameraModel& camera_after, const NearLights& lights_after);

/// From here on maps show it: what costs less is as likely the paper's waves.
inline constexpr double kLeastCost_deg = 0.035, kLeastCostAlbedo = 0.01;
bool matters(const MovementCost& cost);

/// `before` with each LED as bright as these places on the table see it be, by the median, which is what a
/// solve makes of white patches (solve/conditions/drift.h). Unchanged where there is none.
NearLights levelled(const NearLights& before, const NearLights& after, std::span<const LitPlace> places);

}  // namespace weft::calibration
