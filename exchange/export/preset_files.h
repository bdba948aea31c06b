// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "exchange/presets/preset.h"

namespace weft::exchange {

/// Where a preset comes from.
struct KnownPreset {
  std::string name;
  std::filesystem::path file = {};  ///< of a person; empty: weft brings it along
};

/// Where people keep presets of their own: $XDG_CONFIG_HOME/weft/presets, else ~/.config/weft/presets. Empty
/// where neither variable is set.
std::filesystem::path user_preset_folder();

/// All presets by name; one of a person stands for weft's own of the same name.
std::vector<KnownPreset> known_presets();

/// The TOML of a preset: by its name, or of a file where `name_or_file` ends in ".toml". kNoInput with the
/// nearest name.
Result<std::string> preset_text(const std::string& name_or_file);
/// And the preset itself. Errors of preset_from_toml().
Result<Preset> read_preset(const std::string& name_or_file);

}  // namespace weft::exchange
