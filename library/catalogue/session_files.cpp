// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/session_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace weft::library {
namespace {

Error no_frame(const Session& session, int index) {
  return {ErrorKind::kNoInput, "there is no such frame",
          fmt::format("{}, frame {}", session.folder.stem().string(), index), "",
          "see the session for the frames there are"};
}

}  // namespace

namespace fs = std::filesystem;

Result<Shot> stored_shot(const Session& session, const std::string& index) {
  int wanted = -1;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), wanted);
  if (error != std::errc() || end != index.data() + index.size()) {
    return Error{ErrorKind::kUsage, "this is no number of a frame", index.substr(0, 20), "",
                 "use a frame's index, from 0"};
  }
  const auto shot = std::ranges::find(session.shots, wanted, &Shot::index);
  if (shot == session.shots.end()) return no_frame(session, wanted);
  return *shot;
}

Result<StoredFrame> stored_frame(const Session& session, const std::string& index) {
  const Result<Shot> shot = stored_shot(session, index);
  if (!shot) return shot.error();
  if (!lies_in(session.path_of(*shot), session.folder)) return no_frame(session, shot->index);
  return StoredFrame{session.path_of(*shot), shot->sha256};
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code file_error, folder_error;
  const auto real_file = fs::canonical(file, file_error);
  const auto real_folder = fs::canonical(folder, folder_error);
  if (file_error || folder_error) return false;
  return std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end()).first ==
         real_folder.end();
}

std::uint64_t bytes_below(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  fs::recursive_directory_iterator entries(folder, error);
  for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
    std::error_code ignored;
    if (entries->is_symlink(ignored) || !entries->is_regular_file(ignored)) continue;
    const std::uintmax_t size = entries->file_size(ignored);
    if (!ignored) bytes += size;
  }
  return bytes;
}

}  // namespace weft::library
