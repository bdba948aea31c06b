// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "simulator/scene/scene.h"
#include "virtual_rig/commands/command_words.h"

namespace weft::virtual_rig {

/// What of a rig is not any more where it was when somebody calibrated it.
struct Knocks {
  simulator::PoseSettings camera;  ///< added to the scene's
  std::map<int, Vec3> leds_mm;     ///< shifts by LED, from 1
  Vec3 table_mm = {};              ///< shift of the table, with tags and patches and the height of the cloth

  bool operator==(const Knocks&) const = default;
};

/// Changes `knocks` as a person says it: "camera x=2 turn=0.3", "led 3 x=5", "table z=-2",
/// "nothing". What is said counts from where the thing was calibrated, not from where it was pushed before.
/// kUsage with what is allowed.
Result<void> knock(Knocks& knocks, const std::vector<std::string>& words, int leds);

/// The scene as it is after them. Errors: as rig_of().
Result<simulator::Scene> knocked(simulator::Scene scene, const Knocks& knocks);

/// What knock() takes.
std::vector<CommandWords> knock_words();

}  // namespace weft::virtual_rig
