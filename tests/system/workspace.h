// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "tests/system/program.h"

namespace weft::test {

/// An empty folder of the running test and this process, removed with all in it at its end.
class Workspace {
 public:
  Workspace();
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string bytes_of(const std::filesystem::path& file);
void put_bytes(const std::filesystem::path& file, std::string_view bytes);
/// Changes a JSON file in place.
void edit_json(const std::filesystem::path& file, const std::function<void(Json&)>& change);

/// Every file below a folder by its relative path, with the SHA-256 of its bytes, and every folder.
std::map<std::string, std::string> contents_of(const std::filesystem::path& folder);

/// Runs weft and expects that it refuses: with this exit code, with all of `words` in one message on standard
/// error, with nothing on standard output, and with no file or folder of the workspace made, changed or gone.
void expect_refusal(const Workspace& workspace, const std::vector<std::string>& arguments, int exit_code,
                    const std::vector<std::string>& words, const RunOptions& options = {});

}  // namespace weft::test
