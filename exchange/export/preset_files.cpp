// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/preset_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/text.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

bool is_file_name(const std::string& name) {
  return name.ends_with(".toml");
}

Result<KnownPreset> find_preset(const std::string& name) {
  const std::vector<KnownPreset> presets = known_presets();
  const auto found = std::ranges::find(presets, name, &KnownPreset::name);
  if (found != presets.end()) return *found;
  const auto far = [&](const KnownPreset& preset) { return edit_distance(name, preset.name); };
  return Error{ErrorKind::kNoInput, "there is no such preset", name,
               fmt::format("the nearest is {}", std::ranges::min_element(presets, {}, far)->name),
               "list them with weft export --list, or name a file that ends in .toml"};
}

}  // namespace

fs::path user_preset_folder() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && *config != '\0') return fs::path(config) / "weft" / "presets";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return {};
  return fs::path(home) / ".config" / "weft" / "presets";
}

std::vector<KnownPreset> known_presets() {
  std::map<std::string, KnownPreset> by_name;
  for (const ShippedPreset& shipped : shipped_presets()) by_name[shipped.name] = {.name = shipped.name};
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(user_preset_folder(), failed)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".toml") by_name[name] = {name, entry.path()};
  }
  std::vector<KnownPreset> presets;
  for (auto& [name, preset] : by_name) presets.push_back(std::move(preset));
  return presets;
}

Result<std::string> preset_text(const std::string& name_or_file) {
  if (is_file_name(name_or_file)) return read_text(name_or_file);
  const Result<KnownPreset> preset = find_preset(name_or_file);
  if (!preset) return preset.error();
  if (!preset->file.empty()) return read_text(preset->file);
  for (const ShippedPreset& shipped : shipped_presets()) {
    if (shipped.name == preset->name) return std::string(shipped.toml);
  }
  return std::string();
}

Result<Preset> read_preset(const std::string& name_or_file) {
  const Result<std::string> text = preset_text(name_or_file);
  if (!text) return text.error();
  if (is_file_name(name_or_file)) return preset_from_toml(*text, name_or_file);
  const Result<KnownPreset> preset = find_preset(name_or_file);
  if (!preset) return preset.error();
  const std::string where = preset->file.empty() ? "preset " + preset->name : preset->file.string();
  Result<Preset> read = preset_from_toml(*text, where);
  if (read && read->name != preset->name) {
    return Error{ErrorKind::kBadData, "the description cannot be used", where + ": name",
                 fmt::format("it says {}, its file {}", read->name, preset->name), "give both one name"};
  }
  return read;
}

}  // namespace weft::exchange
