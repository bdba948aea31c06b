// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "simulator/bare_rig.h"
#include "simulator/scene/scene.h"
#include "virtual_rig/commands/command_words.h"

namespace weft::virtual_rig {

/// What can lie on the table of a virtual rig, as a person says it.
class RigTable {
 public:
  /// The table of the rig that this scene has, with the scene's cloth on it. Errors: as BareRig::of().
  static Result<RigTable> of(const simulator::Scene& scene);

  const simulator::BareRig& rig() const { return bare_; }

  /// The scene with what `words` name on the table and nothing else of what they could have named: "cloth",
  /// "board tilt=30 azimuth=90 x=20". kUsage with what is allowed where they say anything else; the errors
  /// of read_scene() for "cloth FILE".
  Result<simulator::Scene> with(const std::vector<std::string>& words) const;

 private:
  RigTable(simulator::Scene scene, simulator::BareRig bare)
      : scene_(std::move(scene)), bare_(std::move(bare)) {}

  simulator::Scene scene_;
  simulator::BareRig bare_;
};

/// What Table::with() takes.
std::vector<CommandWords> table_words();

}  // namespace weft::virtual_rig
