// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "material/assets/material_place.h"

namespace weft::app {

/// What jobs may work on: a client sends names and never paths.
struct JobPlaces {
  /// The folder of a session by its name. kUsage, kNoInput.
  std::function<Result<std::filesystem::path>(const std::string& name)> session;
  std::filesystem::path folder;         ///< of the rig: photographs and calibrations lie below it
  std::string rig;                      ///< its name
  std::filesystem::path sessions;       ///< where new ones go
  std::filesystem::path copy;           ///< of finished sessions; empty: where each session says
  std::filesystem::path rig_file = {};  ///< empty: there is no rig
  /// A material of the library by its key. kNoInput.
  std::function<Result<material::MaterialPlace>(const std::string& key)> material = {};
  /// The folder of what was built of one; without an id of the newest build. kNoInput.
  std::function<Result<std::filesystem::path>(const std::string& key, const std::string& id)> build = {};
  /// The folder of a session by its name, whether or not it can be read. kUsage, kNoInput.
  std::function<Result<std::filesystem::path>(const std::string& name)> session_folder = {};
  /// Folders of the sessions that the words of a search find (session_query.h). kUsage.
  std::function<Result<std::vector<std::filesystem::path>>(const std::map<std::string, std::string>& asked)>
      sessions_found = {};
  std::filesystem::path batches = {};  ///< where plans lie (batch_place.h); empty: nowhere
};

/// The refusal of a field of a job's body.
Error unfit_job(const std::string& field, const std::string& rule);

/// What a field of a body names, below a folder where no link leads out of it: a folder or a file that is
/// there, or a folder that is not, whose parent is then made. kUsage, kNoInput, kCannotCreate.
Result<std::filesystem::path> folder_below(const std::filesystem::path& root, const Json& name,
                                           const char* field);
Result<std::filesystem::path> file_below(const std::filesystem::path& root, const Json& name,
                                         const char* field);
Result<std::filesystem::path> new_folder_below(const std::filesystem::path& root, const Json& name,
                                               const char* field);

}  // namespace weft::app
