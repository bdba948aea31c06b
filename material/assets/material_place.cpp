// SPDX-License-Identifier: Apache-2.0
#include "material/assets/material_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <system_error>

#include "core/base/files.h"
#include "core/base/text.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostUserMaterials = 100000;

fs::path data_folder() {
  const char* data = std::getenv("XDG_DATA_HOME");
  if (data != nullptr && fs::path(data).is_absolute()) return data;
  const char* home = std::getenv("HOME");
  return home == nullptr ? fs::path() : fs::path(home) / ".local/share";
}

// "cloth/cotton" of each file below the user's folder; build/ holds what was made of them.
std::map<std::string, fs::path> user_materials() {
  std::map<std::string, fs::path> found;
  const fs::path folder = user_materials_folder();
  std::error_code failure;
  for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, failure),
       end;
       !failure && at != end && found.size() < kMostUserMaterials; at.increment(failure)) {
    if (at->path().filename() == "build") at.disable_recursion_pending();
    if (at->path().extension() != ".toml") continue;
    found[at->path().lexically_relative(folder).replace_extension().generic_string()] = at->path();
  }
  return found;
}

bool ends_as(const std::string& whole, const std::string& last) {
  return whole == last || (whole.size() > last.size() && whole.ends_with(last) &&
                           whole[whole.size() - last.size() - 1] == '/');
}

MaterialPlace place_of(const std::string& name, const std::map<std::string, fs::path>& users) {
  const auto own = users.find(name);
  return {std::string(kLibraryPrefix) + name, own == users.end() ? fs::path() : own->second};
}

std::vector<std::string> library_names(const std::map<std::string, fs::path>& users) {
  std::vector<std::string> names;
  for (const auto& [name, file] : users) names.push_back(name);
  for (const ShippedMaterial& each : shipped_materials()) {
    if (!users.contains(each.name)) names.emplace_back(each.name);
  }
  std::ranges::sort(names);
  return names;
}

Result<MaterialPlace> find_in_library(const std::string& wanted) {
  const std::map<std::string, fs::path> users = user_materials();
  const std::vector<std::string> names = library_names(users);
  if (std::ranges::find(names, wanted) != names.end()) return place_of(wanted, users);
  std::vector<std::string> alike;
  for (const std::string& name : names) {
    if (ends_as(name, wanted)) alike.push_back(name);
  }
  if (alike.size() == 1) return place_of(alike.front(), users);
  const std::string where = std::string(kLibraryPrefix) + wanted;
  if (!alike.empty()) {
    return Error{ErrorKind::kBadData, "there are several such materials", where,
                 fmt::format("{} and {} both end so", alike[0], alike[1]), "give the whole name"};
  }
  const auto distance = [&](const std::string& name) {
    return std::min(edit_distance(wanted, name), edit_distance(wanted, name.substr(name.rfind('/') + 1)));
  };
  const auto nearest = std::ranges::min_element(names, {}, distance);
  return Error{
      ErrorKind::kNoInput, "there is no such material", where,
      nearest == names.end() ? "the library is empty" : fmt::format("the nearest is library:{}", *nearest),
      "weft material list names all"};
}

}  // namespace

fs::path user_materials_folder() {
  const fs::path data = data_folder();
  return data.empty() ? fs::path() : data / "weft/materials";
}

Result<MaterialPlace> find_material(const std::string& written, const fs::path& folder) {
  if (written.starts_with(kLibraryPrefix)) return find_in_library(written.substr(kLibraryPrefix.size()));
  const fs::path file = (folder.empty() ? fs::absolute(written) : folder / written).lexically_normal();
  if (!is_there(file)) {
    return Error{ErrorKind::kNoInput, "there is no such material", file.string(), "no file has this name",
                 "correct it, or write library:NAME for one of weft's own"};
  }
  return MaterialPlace{file.string(), file};
}

std::vector<MaterialPlace> list_materials() {
  const std::map<std::string, fs::path> users = user_materials();
  std::vector<MaterialPlace> places;
  for (const std::string& name : library_names(users)) places.push_back(place_of(name, users));
  return places;
}

Result<std::string> material_text(const MaterialPlace& place) {
  if (!place.is_shipped()) return read_text(place.file);
  const std::string name = place.name.substr(kLibraryPrefix.size());
  const auto found = std::ranges::find(shipped_materials(), name,
                                       [](const ShippedMaterial& m) { return std::string(m.name); });
  if (found != shipped_materials().end()) return std::string(found->text);
  return Error{ErrorKind::kNoInput, "there is no such material", place.name,
               "weft brings none of this name along", "weft material list names all"};
}

}  // namespace weft::material
