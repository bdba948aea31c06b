// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>

#include "core/files.h"
#include "core/result.h"

namespace weft::simulator {

/// A folder under construction, removed unless it was published.
class FolderAside {
 public:
  static Result<FolderAside> make(const std::filesystem::path& target) {
    FolderAside aside;
    aside.path_ = absolute_folder(target);
    aside.path_ += ".partial";
    std::error_code failed;
    if (std::filesystem::create_directory(aside.path_, failed)) return aside;
    const std::filesystem::path path = std::exchange(aside.path_, std::filesystem::path());
    if (failed) return cannot_write(path, failed.value());
    return Error{ErrorKind::kCannotCreate, "another simulation seems to write there", path.string(),
                 "the folder exists", "wait for it, or remove the folder if that simulation was killed"};
  }
  FolderAside(FolderAside&& other) noexcept : path_(std::exchange(other.path_, std::filesystem::path())) {}
  FolderAside& operator=(FolderAside&&) = delete;
  ~FolderAside() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  Result<void> publish(const std::filesystem::path& target) {
    Result<void> published = publish_folder(path_, target);
    if (published) path_.clear();
    return published;
  }

 private:
  FolderAside() = default;
  std::filesystem::path path_;
};

}  // namespace weft::simulator
