// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/rig/lights.h"
#include "solver/light_plan/planned_rig.h"
#include "solver/reflectance/lobe.h"

// What lights can tell of a cloth, before one photograph is taken.

namespace weft::solver {

/// A cloth of one material.
struct ForeseenCloth {
  Lobe lobe;
  double albedo = 0.3;
  double relief_deg = 20;  ///< mean slope; 0: level
  double weft_share = 0;   ///< pixels whose yarn lies across the lobe's axis
  double pixels = 4000;    ///< that share the lobe
};

/// A pixel that stands for others like it.
struct ClothSite {
  Vec3 place_mm, normal;
  double yarn = 0;  ///< azimuth from the lobe's axis, radians
};
/// Gaussian slopes in each place of the rig: the same for the same cloth.
std::vector<ClothSite> sites_of(const ForeseenRig& rig, const ForeseenCloth& cloth);

/// What is made of the rig's errors.
enum class RigErrors {
  kTaken,  ///< nothing: the rig is taken to be as it was calibrated, as a solve does
  kFitted  ///< they are fitted with the cloth, within what is known of them: the least that can be reached
};

/// What one scan lights.
struct LightSet {
  std::vector<std::size_t> leds = {};   ///< of the rig, from 0
  std::optional<NearLight> added = {};  ///< one more
  RigErrors errors = RigErrors::kTaken;
  bool has_polarisers = false;  ///< each LED twice, with films crossed and parallel
  /// Each reading once more at so many times the exposure, where that does not fill the sensor.
  std::optional<double> bracket = {};
  double fade = 0;  ///< share by which the LEDs may fade from the first to the last, unseen
};

/// Standard deviations. Infinite: the photographs do not tell it. With RigErrors::kFitted no unbiased
/// estimate beats them (Rao 1945, Cramer 1946).
struct ForeseenSigma {
  double normal_deg = 0;       ///< rms angle of a pixel's normal, mean over pixels that have one
  double alpha = 0, f0 = 0;    ///< of a lobe; of a cloth lobe f0 is the strength of its sheen
  double alpha_along = 0;      ///< of a lobe with two roughnesses
  double axis_deg = 0;         ///< of such a lobe
  double correlation = 0;      ///< of log alpha and f0
  double unsolved = 0;         ///< share of pixels whose normal is not told to kWorstNormal_deg
  bool is_observable = false;  ///< alpha to 0.05 and f0 to a quarter by two sigma, and not its tail alone
};

/// Fisher information of a cloth under a rig's lights. Readings have the sensor's noise and kLobeModelShare
/// of model error. Each pixel's own normal and albedo are eliminated (Schur 1917); what pixels share is the
/// lobe, a bend of the diffuse part, stray light, and strength and direction of each LED, the last three
/// within what is known of them.
class LightPlan {
 public:
  LightPlan(ForeseenRig rig, ForeseenCloth cloth);
  ~LightPlan();
  LightPlan(LightPlan&&) noexcept;

  const ForeseenRig& rig() const;
  const ForeseenCloth& cloth() const;
  LightSet as_it_is() const;
  /// May be called from any thread.
  ForeseenSigma sigma_of(const LightSet& lights) const;
  /// Sigmas with each LED in turn taken from where it is to this place. May be called from any thread.
  std::vector<ForeseenSigma> moved_to(const NearLight& place) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// What is known of a bend of the diffuse part, and of stray light over that of a white surface.
inline constexpr double kKnownBend = 0.05, kKnownStray = 0.0005;
inline constexpr double kWorstNormal_deg = 10;
/// Below this correlation of log alpha and f0 only the tail of a lobe is seen, which tells f0 alpha^2 alone.
inline constexpr double kTailOnly = -0.98;
/// Share of the lobe that crossed films let through.
inline constexpr double kLeak = 0.01;

}  // namespace weft::solver
