// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/job_places.h"

#include "app/server/api/bodies/body_fields.h"
#include "core/base/files.h"
#include "library/catalogue/session_files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestFolder = 200;

// Words between slashes, below a folder.
Result<fs::path> place_below(const fs::path& root, const Json& name, const char* field) {
  if (!name.is_string()) return unfit_job(field, "must be a text");
  const std::string& text = name.get_ref<const std::string&>();
  bool fits = text.size() <= kLongestFolder && !root.empty();
  for (std::string_view rest = text; fits; rest.remove_prefix(rest.find('/') + 1)) {
    fits = is_plain(rest.substr(0, rest.find('/')));
    if (rest.find('/') == std::string_view::npos) break;
  }
  if (!fits) return unfit_job(field, "must name a folder below that of the rig file: photographs/board");
  return root / text;
}

Result<void> check_inside(const fs::path& place, const fs::path& root, bool is_file) {
  std::error_code error;
  const bool is_it = is_file ? fs::is_regular_file(place, error) : fs::is_directory(place, error);
  if (is_it && library::lies_in(place, root)) return {};
  return Error{ErrorKind::kNoInput, is_file ? "there is no such file" : "there is no such folder",
               place.lexically_relative(root).string(), "it is looked for below the rig file's",
               "copy it there first"};
}

Result<fs::path> what_is_below(const fs::path& root, const Json& name, const char* field, bool is_file) {
  Result<fs::path> place = place_below(root, name, field);
  if (!place) return place;
  const Result<void> inside = check_inside(*place, root, is_file);
  return inside ? place : inside.error();
}

}  // namespace

Error unfit_job(const std::string& field, const std::string& rule) {
  return {ErrorKind::kUsage, "job cannot be read", field, rule, "see POST jobs in openapi.json"};
}

Result<fs::path> folder_below(const fs::path& root, const Json& name, const char* field) {
  return what_is_below(root, name, field, false);
}

Result<fs::path> file_below(const fs::path& root, const Json& name, const char* field) {
  return what_is_below(root, name, field, true);
}

Result<fs::path> new_folder_below(const fs::path& root, const Json& name, const char* field) {
  Result<fs::path> folder = place_below(root, name, field);
  if (!folder) return folder;
  if (is_there(*folder)) {
    return Error{ErrorKind::kCannotCreate, "there is something of this name already",
                 folder->lexically_relative(root).string(), "", "name another folder"};
  }
  fs::path parent = folder->parent_path();
  while (!is_there(parent)) parent = parent.parent_path();
  if (Result<void> inside = check_inside(parent, root, false); !inside) return inside.error();
  const Result<void> made = make_writable_folder(folder->parent_path());
  return made ? folder : made.error();
}

}  // namespace weft::app
