// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/json_document.h"
#include "core/base/temporary_folder.h"

namespace weft::library {

/// A folder of sessions without photographs.
class Shelf {
 public:
  std::filesystem::path path() const { return folder_.path() / "sessions"; }
  std::filesystem::path beside(const std::string& name) const { return folder_.path() / name; }
  std::filesystem::path folder_of(const std::string& name) const { return path() / (name + ".weft"); }

  /// Writes its session.json; `fields` replace those of a finished scan of twill on rig bench-1.
  std::filesystem::path put(const std::string& name, const Json& fields = Json::object()) const;
  /// Adds a finished solve without maps; `fields` go into its solve.json.
  void solve(const std::string& name, const std::string& id, const Json& fields = Json::object()) const;

 private:
  TemporaryFolder folder_;
};

}  // namespace weft::library
