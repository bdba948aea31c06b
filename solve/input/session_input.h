// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "core/solve/solve_parts.h"
#include "solve/conditions/drift.h"
#include "solve/conditions/led_gains.h"
#include "solve/conditions/useless_lights.h"
#include "solve/photographs/photographs.h"
#include "solver/method.h"

namespace weft::app {

/// Which session is solved, and by which of its LEDs.
struct SessionOptions {
  std::filesystem::path folder;
  std::filesystem::path calibration;  ///< empty: the session's own
  std::vector<int> leds;              ///< empty: all that were lit
  Json accepted_moved = {};           ///< beside the session's own word (docs/formats.md)
};

/// A session that has been looked at but not read: everything that can be checked before an hour of work.
struct SessionPlan {
  Session session;
  Calibration calibration;
  std::vector<Shot> lit;       ///< the shots to solve from, by LED: of a pair of film states the crossed ones
  std::vector<Shot> parallel;  ///< of a pair the others, of the same LEDs in the same order; else none
  std::optional<Shot> dark;
  std::vector<Shot> repeats;   ///< second shots of LEDs in `lit`
  std::vector<Shot> brackets;  ///< shots of LEDs in `lit` whose exposure ratio the calibration measured
  Size size;
  bool raw = true;                    ///< mosaics; else linear TIFF, PNG or EXR
  SolveInput input;                   ///< for solve.json, and what the id of the solve is made of
  std::vector<std::string> warnings;  ///< about shots that will not be used
  solver::Extent extent = solver::Extent::kTiles;  ///< of the level that will be solved by

  /// All shots whose frames are read: lit, dark, repeats, parallel, brackets.
  std::vector<Shot> frames() const;
};

Result<SessionPlan> plan_session(const SessionOptions& options);

/// plan_session() by a calibration that was read before, with no look at the frames: their names tell whether
/// they are raw, and the calibration's camera how large they are. Errors as of plan_session(), but for what
/// frames alone show.
Result<SessionPlan> plan_unopened(const SessionOptions& options, const Calibration& calibration);

/// Bytes that decoding and solving will hold at once: the frames, one more for every thread that decodes,
/// bands, and what the level keeps of the whole frame.
std::uint64_t memory_needed(const SessionPlan& plan, int threads);

/// A LED that was not solved from, and why.
struct LeftOutLed {
  int led = 0;
  pipeline::UselessLight::Why why = pipeline::UselessLight::Why::kNotLit;
};

/// How bright a LED was against its calibration.
struct LedDrift {
  int led = 0;
  double factor = 1;
};

/// What was found in the frames and corrected: docs/conditions.md.
struct SessionConditions {
  std::optional<std::size_t> replaced_photosites;  ///< of raw frames
  std::optional<double> veil;                      ///< share of the light that was taken from every reading
  std::size_t brackets = 0;                        ///< shots that were joined
  std::vector<LeftOutLed> left_out;                ///< by LED
  pipeline::Drift::Source drift_source = pipeline::Drift::Source::kNone;
  std::vector<LedDrift> drift;  ///< of every LED that is solved from, where there is a source
  std::optional<pipeline::LedGains> cloth_gains;  ///< that the cloth told, where they were applied
  std::vector<int> leds;                          ///< of cloth_gains
};
ConditionFacts facts_of(const SessionConditions& conditions);

/// A session in memory, corrected and ready to be solved.
struct LoadedSession {
  pipeline::Photographs photographs;
  SessionConditions conditions;
  std::vector<std::string> warnings;  ///< a sentence each
};

/// Reads, checks against their digests and decodes every frame once, and corrects for the conditions they
/// were taken in (solve/input/session_conditions.h).
Result<LoadedSession> load_session(const SessionPlan& plan, const JobContext& context);

}  // namespace weft::app
