// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_options.h"

#include <cstdlib>
#include <system_error>

namespace weft::app {

namespace fs = std::filesystem;

void add_rig_file(Options& options, fs::path& rig) {
  options.add("--rig", &rig,
              "Rig file (docs/rig.md); default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml");
}

void add_leds(Options& options, std::vector<int>& leds) {
  options.add("--leds", &leds, "LEDs, numbered from 1: 1,4,7; default all").by_commas().in_range(1, 10);
}

fs::path find_rig(const fs::path& said) {
  if (!said.empty()) return said;
  if (const char* named = std::getenv("WEFT_RIG"); named != nullptr && *named != '\0') return named;
  std::error_code ignored;
  if (fs::exists("rig.toml", ignored)) return "rig.toml";
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && *config != '\0') return fs::path(config) / "weft/rig.toml";
  const char* home = std::getenv("HOME");
  return fs::path(home == nullptr ? "/" : home) / ".config/weft/rig.toml";
}

}  // namespace weft::app
