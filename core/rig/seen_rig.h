// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "core/describe/fields.h"

namespace weft {

/// Beside session.json: what a scan shows of its rig (weft.rig-look/1, written by
/// calibration/run/rig_look.h).
inline constexpr const char* kRigLookFile = "rig.json";
inline constexpr const char* kRigLookSchema = "weft.rig-look";

enum class RigPlace {
  kInPlace,      ///< or what changed costs nothing that maps show
  kDimmed,       ///< LEDs are brighter or weaker, which each solve puts right by patches or by the cloth
  kMoved,        ///< it costs what maps show
  kUnexplained,  ///< what is seen contradicts the calibration, and no change of the rig explains it
  kUnseen        ///< neither tags of the calibration nor its patches are in sight
};
inline constexpr std::array kRigPlaceNames = {"in place", "dimmed", "moved", "unexplained", "not seen"};

/// What such a look comes to.
struct RigLookFacts {
  std::string taken;        ///< the first photograph; ISO 8601
  std::string calibration;  ///< id of the one that it is held against
  std::string photographs;  ///< solve::digest_of_photographs(); empty: not of a session
  RigPlace state = RigPlace::kUnseen;
  std::string says;         ///< "camera moved 3.0 mm, costs 0.12 degrees"
  std::string action = {};  ///< an imperative phrase; empty: nothing is to do

  /// Scans by this calibration are not to be trusted.
  bool is_bad() const { return state == RigPlace::kMoved || state == RigPlace::kUnexplained; }
};
void describe(Fields& fields, RigLookFacts& look);

/// That of a session; none: nobody looked, or it cannot be read.
std::optional<RigLookFacts> read_rig_look(const std::filesystem::path& session);

}  // namespace weft
