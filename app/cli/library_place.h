// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "app/cli/verb.h"
#include "core/base/result.h"
#include "library/catalogue/catalogue.h"

namespace weft::app {

/// Where verbs look for sessions by what people say of them.
struct LibraryPlace {
  std::vector<std::string> folders;
  std::filesystem::path catalogue;
};

/// Adds --in and --catalogue.
void add_place(Options& options, LibraryPlace& place);

/// $VARIABLE/weft where that is an absolute folder, else $HOME/BELOW/weft.
std::filesystem::path folder_of_user(const char* variable, const char* below_home);

/// The folders named, else those of WEFT_LIBRARY, else the current one.
std::vector<std::filesystem::path> folders_of(const LibraryPlace& place);
/// The file: of each choice of folders one of its own, in the user's cache.
std::filesystem::path catalogue_of(const LibraryPlace& place);
/// The catalogue as the folders are now; what cannot be listed is noted.
Result<library::Catalogue> fresh_catalogue(const LibraryPlace& place, const CommonArguments& common);

}  // namespace weft::app
