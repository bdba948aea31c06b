// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include "core/exposure_words.h"

namespace weft::app {
namespace {

/// Takes a number off the front of a text.
std::optional<double> take_number(std::string_view& text) {
  double number = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// Microseconds of what stands behind a number; none where it is no unit.
std::optional<double> unit_in_us(std::string_view text, bool is_fraction) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  if (text.empty()) return is_fraction ? 1e6 : 1;
  constexpr std::array<std::pair<std::string_view, double>, 3> kUnits = {
      {{"us", 1}, {"ms", 1e3}, {"s", 1e6}}};
  const auto* found = std::ranges::find(kUnits, text, &std::pair<std::string_view, double>::first);
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

namespace fs = std::filesystem;

void add_rig_file(Options& options, fs::path& rig) {
  options.add("--rig", &rig,
              "Rig file (docs/rig.md); default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml");
}

void add_leds(Options& options, std::vector<int>& leds) {
  options.add("--leds", &leds, "LEDs, numbered from 1: 1,4,7; default all").by_commas().in_range(1, 10);
}

void add_exposure(Options& options, std::optional<std::string>& exposure, const std::string& otherwise) {
  options.add(
      "--exposure", &exposure,
      "Shutter time: 20ms, 0.5s, 1/60 or, without a unit, us; the camera's nearest is taken; default " +
          otherwise);
}

Result<double> exposure_in_us(const std::optional<std::string>& text, double most_us) {
  if (!text) return 0.0;
  const auto refuse = [&](std::string why) {
    return Error{ErrorKind::kUsage, "the exposure cannot be taken", "--exposure " + *text, std::move(why),
                 "write it as 20ms, 0.5s or 1/60"};
  };
  std::string_view left = *text;
  std::optional<double> number = take_number(left), below = 1;
  const bool is_fraction = left.starts_with('/');
  if (is_fraction) {
    left.remove_prefix(1);
    below = take_number(left);
  }
  const std::optional<double> unit_us = unit_in_us(left, is_fraction);
  if (!number || !below || !unit_us) return refuse("it is no time");
  const double exposure_us = *number / *below * *unit_us;
  if (exposure_us >= 1 && exposure_us <= most_us) return exposure_us;
  return refuse(fmt::format("it must be 1 us to {}", exposure_words(most_us)));
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
