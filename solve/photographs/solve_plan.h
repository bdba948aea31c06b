// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/image_io/linear_image.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "core/solve/solve_parts.h"
#include "solver/method.h"
#include "solver/transport/cloth_spread.h"

namespace weft::solve {

/// What will be solved, looked at but not decoded: shots of a session, or photographs that no rig took. Those
/// stand as lit shots too, led being their number in the list, by a calibration that has their lights alone.
struct SolvePlan {
  bool is_of_rig = true;
  std::string where;  ///< for messages
  Session session;
  Calibration calibration;
  std::vector<Shot> lit;       ///< the shots to solve from, by LED: of a pair of film states the crossed ones
  std::vector<Shot> parallel;  ///< of a pair the others, of the same LEDs in the same order; else none
  std::optional<Shot> dark;
  std::vector<Shot> repeats;   ///< second shots of LEDs in `lit`
  std::vector<Shot> brackets;  ///< shots of LEDs in `lit` whose exposure ratio the calibration measured
  std::optional<Shot> blade;   ///< of a LED in `lit`, with a blade above the cloth
  Size size;
  bool raw = true;                        ///< mosaics; else linear TIFF, PNG or EXR
  int orientation = 1;                    ///< that developed photographs are turned by (as_shown())
  double ambient = 0;                     ///< that is taken from developed photographs, a share of full scale
  bool transfer_is_custom = false;        ///< neither the files nor a person said how values follow light
  std::filesystem::path mask;             ///< where the cloth is; empty: every pixel counts
  int mask_orientation = 1;               ///< that the mask is turned by
  Transfer transfer = Transfer::kLinear;  ///< kAuto: files differ, and each is taken by its own kind
  Clipped clipped = Clipped::kMark;
  SolveInput input;                   ///< for solve.json, and what the id of the solve is made of
  std::vector<std::string> warnings;  ///< about shots that will not be used
  /// What was taken for granted of photographs and the file of their lights, each a few words.
  std::vector<std::string> assumed;
  solver::Extent extent = solver::Extent::kTiles;  ///< of the level that will be solved by
  std::shared_ptr<const SolvePlan> second_pose;    ///< in which the lobe is sought too; null: none

  /// That is to be undone, as a person says; share 0: none. Else as the cloth and the blade's shadow tell.
  std::optional<solver::ClothSpread> cloth_spread;

  bool asks_frames = false;  ///< whether frames and dark shot are asked if they lie: those of a cloth are

  std::string session_name;      ///< of a session's folder, as commands take it
  std::filesystem::path solves;  ///< the folder that solves go to
  std::filesystem::path truth;   ///< normal.exr of a simulated session; else empty

  /// All shots whose frames are read: lit, dark, repeats, parallel, brackets, blade.
  std::vector<Shot> frames() const;
  std::vector<std::filesystem::path> files() const;  ///< theirs
  /// The number of each lit shot's light.
  std::vector<int> numbers() const;
};

}  // namespace weft::solve
