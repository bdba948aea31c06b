// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "core/base/json_document.h"

// Ways from photographs to a calibration that the rig scans with, as weft calibrate and the page walk them.

namespace weft::calibration {

/// Photographs, and what is made of them.
struct WalkStage {
  std::string_view result;  ///< what its folder ends with
  std::string_view part;    ///< of its photographs (photograph_set.h)
  std::string_view title;   ///< for people, as `about`
  std::string_view about;
  std::string_view job;    ///< the kind of job that reads the photographs
  std::string_view thing;  ///< board, sheet or chart, which must be described to be found; empty: none
  bool is_optional = false;
  /// Its photographs are read by the stage after it; a walk comes by it only where a person chooses it.
  bool is_aside = false;
  bool is_photographed = false;  ///< the stage before it has taken its photographs
};

inline constexpr std::string_view kWalkCheck = "check", kWalkMoved = "moved";

/// The whole of a new rig.
std::span<const WalkStage> walk_of_all();
/// What a knock made necessary.
std::span<const WalkStage> walk_of_refresh();

/// {"all": [{"result", "part", ...}], "refresh": [...]}
Json json_of_walks();

}  // namespace weft::calibration
