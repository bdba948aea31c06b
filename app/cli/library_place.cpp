// SPDX-License-Identifier: Apache-2.0
#include "app/cli/library_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "app/cli/terminal.h"
#include "core/base/files.h"
#include "core/base/sha256.h"

namespace weft::app {

namespace fs = std::filesystem;

void add_place(Options& options, LibraryPlace& place) {
  options
      .add("--in", &place.folders,
           "Folder of sessions, with those below it; may be given again. Default: WEFT_LIBRARY (folders "
           "parted "
           "by colons), else the current folder")
      .one_at_a_time();
  options.add("--catalogue", &place.catalogue,
              "SQLite file; default one for these folders in the user's cache");
}

fs::path folder_of_user(const char* variable, const char* below_home) {
  const char* named = std::getenv(variable);
  if (named != nullptr && *named == '/') return fs::path(named) / "weft";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr && *home == '/' ? home : "/tmp") / below_home / "weft";
}

std::vector<fs::path> folders_of(const LibraryPlace& place) {
  std::vector<fs::path> folders;
  for (const std::string& folder : place.folders) folders.push_back(absolute_folder(folder));
  if (!folders.empty()) return folders;
  const char* named = std::getenv("WEFT_LIBRARY");
  std::string_view rest = named != nullptr ? named : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    if (!folder.empty()) folders.push_back(absolute_folder(folder));
    rest.remove_prefix(std::min(folder.size() + 1, rest.size()));
  }
  if (folders.empty()) folders.push_back(absolute_folder("."));
  return folders;
}

fs::path catalogue_of(const LibraryPlace& place) {
  if (!place.catalogue.empty()) return place.catalogue;
  std::string all;
  for (const fs::path& folder : folders_of(place)) all += folder.string() + "\n";
  return folder_of_user("XDG_CACHE_HOME", ".cache") /
         fmt::format("library-{}.sqlite", sha256_of(all).substr(0, 16));
}

Result<library::Catalogue> fresh_catalogue(const LibraryPlace& place, const CommonArguments& common) {
  Result<library::Catalogue> catalogue = library::Catalogue::open(catalogue_of(place));
  if (!catalogue) return catalogue;
  const std::vector<fs::path> folders = folders_of(place);
  if (Result<void> ok = catalogue->keep_only(folders); !ok) return std::move(ok).error();
  const Result<library::RefreshFacts> facts = [&] {
    ProgressLine line(common.quiet);
    return catalogue->refresh(folders, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!facts) return facts.error();
  for (const fs::path& lost : facts->unreachable)
    note(fmt::format("{} cannot be listed: its sessions are shown as they were", lost.string()));
  return catalogue;
}

}  // namespace weft::app
