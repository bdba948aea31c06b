// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options.h"

// What the verbs of a rig have alike.

namespace weft::app {

/// --rig
void add_rig_file(Options& options, std::filesystem::path& rig);
/// --leds
void add_leds(Options& options, std::vector<int>& leds);

/// --exposure, from 1 us.
void add_exposure(Options& options, std::optional<double>& exposure_us, double most_us,
                  const std::string& otherwise);

/// The rig file that a person named: `said`, else $WEFT_RIG; empty: none.
std::filesystem::path named_rig(const std::filesystem::path& said);

/// The rig file of a command: the named one, else ./rig.toml, else $XDG_CONFIG_HOME/weft/rig.toml
/// (~/.config).
std::filesystem::path find_rig(const std::filesystem::path& said);

}  // namespace weft::app
