// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "core/result.h"

// What the verbs of a rig have alike.

namespace weft::app {

/// --rig
void add_rig_file(Options& options, std::filesystem::path& rig);
/// --leds
void add_leds(Options& options, std::vector<int>& leds);

/// --exposure, as exposure_in_us() reads it.
void add_exposure(Options& options, std::optional<std::string>& exposure, const std::string& otherwise);
/// "20ms", "0.5s", "1/60" (of a second), "20000" (us); 0 where there is none. kUsage for what is no exposure
/// or outside 1 us to this.
Result<double> exposure_in_us(const std::optional<std::string>& text, double most_us);

/// The rig file that a person named: `said`, else $WEFT_RIG; empty: none.
std::filesystem::path named_rig(const std::filesystem::path& said);

/// The rig file of a command: the named one, else ./rig.toml, else $XDG_CONFIG_HOME/weft/rig.toml
/// (~/.config).
std::filesystem::path find_rig(const std::filesystem::path& said);

}  // namespace weft::app
