// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/lights.h"
#include "core/result.h"
#include "pipeline/photographs.h"

// How bright each light was in its shot against its calibration, and the field put right
// (solver/conditions/light_change.h).

namespace weft::pipeline {

/// A light that was lit once more. Times are in any unit.
struct Repeat {
  std::size_t light = 0;  ///< of the photographs, from 0
  std::size_t frame = 0;  ///< of DriftEvidence::again
  double earlier_time = 0;
  double later_time = 0;
};

struct DriftEvidence {
  std::vector<WhitePatch> patches = {};
  Frames again = {};  ///< the repeats' frames
  std::vector<Repeat> repeats = {};
  std::vector<double> times = {};  ///< of each photograph
  double first_time = 0;           ///< when the session began: all lights are as calibrated
};

struct Drift {
  enum class Source { kNone, kPatches, kRepeats };
  Source source = Source::kNone;
  std::vector<double> measured;             ///< brightness of each light; empty where there is no source
  std::optional<std::size_t> unread_light;  ///< in whose light no patch can be read: patches were not used
  /// What each repeat gave of its earlier shot, or nothing where they share no light; empty where patches
  /// told.
  std::vector<std::optional<double>> ratios;

  /// The brightness of light k as the field has it afterwards: 1 where it changed too much to be drift.
  double factor(std::size_t k) const;
};

/// No LED drifts by more between two shots: beyond it something else happened.
inline constexpr double kMostDrift = 0.2;
bool is_drift(double factor);

/// White patches tell of each light; without a patch that can be read in all of them, repeats tell of a drift
/// that is the same for all lights and straight in time. Repeats that are no drift are not used.
Drift find_drift(const Photographs& photographs, const DriftEvidence& evidence, int threads);

/// Gives the field's lights their factors. Errors: as LightField::make.
Result<void> follow(const Drift& drift, Photographs& photographs);

}  // namespace weft::pipeline
