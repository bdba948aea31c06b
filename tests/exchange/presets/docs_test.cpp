// SPDX-License-Identifier: Apache-2.0
// docs/reference/exports.md has the tables that the presets and the catalogue make.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/base/files.h"
#include "exchange/presets/preset.h"
#include "tests/core/places.h"

namespace weft::exchange {
namespace {

// "normal" for all three parts, "albedo" for all three colours.
std::string words_of(const std::vector<std::string>& channels) {
  std::string words;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (i > 0) words += ", ";
    const std::size_t dot = channels[i].rfind('.');
    const std::string stem = channels[i].substr(0, dot);
    const std::string ending = dot == std::string::npos ? "" : channels[i].substr(dot);
    const auto follows = [&](std::size_t k, const std::string& part) {
      return i + k < channels.size() && channels[i + k] == stem + part;
    };
    if (ending == ".r" && follows(1, ".g") && follows(2, ".b")) {
      words += stem;
      i += 2;
    } else if (ending == ".x" && follows(1, ".y") && follows(2, ".z")) {
      words += stem;
      i += 2;
    } else {
      words += channels[i];
    }
  }
  return words;
}

std::string row_of(const Preset& preset) {
  std::string files;
  for (const PresetFile& file : preset.files) {
    const bool has_own = preset.normal == "both" && file.channels.front() == "normal.x";
    const std::string color = file.stored.color == ColorSpace::kSrgb          ? ", srgb"
                              : file.stored.color == ColorSpace::kLinearColor ? ", linear"
                                                                              : "";
    files += fmt::format(
        "{}`{}` {} ({}{}{}{})", files.empty() ? "" : "; ", file.name, words_of(file.channels),
        words_of(file.stored), color,
        has_own ? std::string(", ") + kNormalDirectionNames[static_cast<std::size_t>(file.direction)] : "",
        file.is_optional ? ", optional" : "");
  }
  for (const PresetDocument& document : preset.documents)
    files += fmt::format("; **`{}`**{}", document.name, document.is_optional ? " (optional)" : "");
  return fmt::format("| `{}` | {} | {} | {} |\n", preset.name, files, preset.normal,
                     kRoughnessConventionNames[static_cast<std::size_t>(preset.roughness)]);
}

std::string preset_table() {
  std::string table = "| preset | files | normals | roughness |\n|---|---|---|---|\n";
  for (const ShippedPreset& shipped : shipped_presets()) {
    const Result<Preset> preset = preset_from_toml(shipped.toml, shipped.name);
    EXPECT_TRUE(preset) << preset.error().message();
    if (preset) table += row_of(*preset);
  }
  return table;
}

std::string channel_table() {
  std::string table = "| channel | holds | range | from |\n|---|---|---|---|\n";
  for (const Channel& channel : channel_catalogue()) {
    std::string from;
    for (const MapPlane plane : channel.planes) {
      const std::string map = kind_of(plane).map;
      if (from.find(map) == std::string::npos) from += (from.empty() ? "" : ", ") + map;
    }
    const std::string range = std::string(channel.name) == "height"
                                  ? "of the cloth, mm"
                                  : fmt::format("{:g} to {:g}", channel.least, channel.most);
    table += fmt::format("| `{}` | {} | {} | {} |\n", channel.name, channel.says, range, from);
  }
  return table;
}

std::string part_of_page(const std::string& begin, const std::string& end) {
  const Result<std::string> page = read_text(in_sources("docs/reference/exports.md"));
  EXPECT_TRUE(page);
  if (!page) return "";
  const std::size_t at = page->find('\n', page->find("<!-- " + begin)), to = page->find("<!-- " + end);
  if (at == std::string::npos || to == std::string::npos) return "";
  return page->substr(at + 1, to - at - 1);
}

TEST(ExportsPage, HasTheTableThatThePresetsMake) {
  EXPECT_EQ(part_of_page("presets:", "end of presets"), preset_table()) << preset_table();
}

TEST(ExportsPage, HasTheTableThatTheCatalogueMakes) {
  EXPECT_EQ(part_of_page("channels:", "end of channels"), channel_table()) << channel_table();
}

}  // namespace
}  // namespace weft::exchange
