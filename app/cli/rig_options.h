// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/cli/options.h"

// What the verbs of a rig have alike.

namespace weft::app {

/// --rig
void add_rig_file(Options& options, std::filesystem::path& rig);
/// --leds
void add_leds(Options& options, std::vector<int>& leds);

/// The rig file of a command: `said`, else $WEFT_RIG, else ./rig.toml, else
/// $XDG_CONFIG_HOME/weft/rig.toml (~/.config).
std::filesystem::path find_rig(const std::filesystem::path& said);

}  // namespace weft::app
