// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_options.h"

#include <cstdlib>
#include <system_error>

#include "app/cli/described_options.h"
#include "core/describe/described_fields.h"

namespace weft::app {

namespace fs = std::filesystem;

void add_rig_file(Options& options, fs::path& rig) {
  options.add("--rig", &rig,
              "Rig file (docs/rig.md); default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml");
}

void add_leds(Options& options, std::vector<int>& leds) {
  options.add("--leds", &leds, "LEDs, numbered from 1: 1,4,7; default all").by_commas().in_range(1, 10);
}

void add_exposure(Options& options, std::optional<double>& exposure_us, double most_us,
                  const std::string& otherwise) {
  OptionFields fields(options);
  describe_exposure(fields, exposure_us, {1, most_us}, otherwise);
}

fs::path named_rig(const fs::path& said) {
  const char* named = std::getenv("WEFT_RIG");
  return said.empty() && named != nullptr ? fs::path(named) : said;
}

fs::path find_rig(const fs::path& said) {
  if (fs::path named = named_rig(said); !named.empty()) return named;
  std::error_code ignored;
  if (fs::exists("rig.toml", ignored)) return "rig.toml";
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && *config != '\0') return fs::path(config) / "weft/rig.toml";
  const char* home = std::getenv("HOME");
  return fs::path(home == nullptr ? "/" : home) / ".config/weft/rig.toml";
}

}  // namespace weft::app
