// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/rig/lights.h"
#include "solve/conditions/conditions.h"
#include "solve/photographs/photographs.h"
#include "solver/conditions/light_change.h"

// How bright each light was in its shot against its calibration, and the field put right
// (solver/conditions/light_change.h).

namespace weft::solve {

/// A light that was lit once more. Times are in any unit.
struct RepeatedLight {
  std::size_t light = 0;  ///< of the photographs, from 0
  std::size_t frame = 0;  ///< of DriftEvidence::again
  double earlier_time = 0;
  double later_time = 0;
};

struct DriftEvidence {
  std::vector<WhitePatch> patches = {};
  Frames again = {};  ///< the repeats' frames
  std::vector<RepeatedLight> repeats = {};
  std::vector<double> times = {};  ///< of each photograph
  double first_time = 0;           ///< when the session began: all lights are as calibrated
};

/// A white patch whose light of one LED is not what the others say of that LED: kMostScatter.
struct PatchDeparture {
  std::size_t patch = 0;
  std::size_t light = 0;
  double ratio = 1;  ///< its factor over the median of all patches
};

struct Drift {
  enum class Source { kNone, kPatches, kRepeats };
  Source source = Source::kNone;
  std::vector<double> measured;             ///< brightness of each light; empty where there is no source
  std::optional<std::size_t> unread_light;  ///< in whose light no patch can be read: patches were not used
  std::vector<PatchDeparture> departures;   ///< patch by patch, where patches told
  std::optional<std::size_t> misplaced;     ///< so many patches contradict the others: patches were not used
  /// What each repeat gave of its earlier shot, or nothing where they share no light; empty where patches
  /// told.
  std::vector<std::optional<double>> ratios;

  /// The brightness of light k as the field has it afterwards: 1 where it changed too much to be drift.
  double factor(std::size_t k) const;
};

/// No LED drifts by more between two shots: beyond it something else happened.
inline constexpr double kMostDrift = 0.2;
bool is_drift(double factor);
/// Patches differ by no more, relative: beyond it something lies on one, or shades it.
inline constexpr double kMostScatter = 0.01;
/// Where half of four patches or more differ by so much under most lights, they are not where the calibration
/// has them: camera or table moved.
inline constexpr double kMisplaced = 0.03;

/// What each photograph shows of a patch, well inside it; nothing where it cannot be read: it lies outside
/// the frame, is unlit, or full over more than half of it. `field` is at the patch's height.
std::vector<std::optional<solver::PatchLight>> read_patch(const Photographs& photographs,
                                                          const WhitePatch& patch, const LightField& field);

/// White patches tell of each light by the median of their factors, so that one that is covered or shaded
/// tells nothing; each is predicted at its own height, place by place. Without a patch that can be read in
/// all of them, repeats tell of a drift that is the same for all lights and straight in time. Repeats that
/// are no drift are not used.
Drift find_drift(const Photographs& photographs, const DriftEvidence& evidence, int threads);

/// Gives the field's lights their factors. Errors: as LightField::make.
Result<void> follow(const Drift& drift, Photographs& photographs);

/// Measures how bright each LED was in its shot, and gives the field's lights that brightness. Errors: as
/// LightField::make.
Result<void> follow_drift(const Exposures& exposures);

/// Whether white patches told what follow_drift() said.
bool was_told_by_patches(const ConditionFacts& facts);

}  // namespace weft::solve
