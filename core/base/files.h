// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace weft {

/// The absolute path of a folder whose last part is its name, whatever way it was written: "a/b/", "a/./b".
std::filesystem::path absolute_folder(const std::filesystem::path& folder);

/// Whether there is something at `path` that this user can see; a folder that may not be entered shows
/// nothing.
bool is_there(const std::filesystem::path& path);

/// The same where much hangs on it: false only where the system says that there is nothing, not even a link
/// that leads nowhere. kInputOutput where it does not tell: a folder that may not be entered, a disk that
/// fails.
Result<bool> look_for(const std::filesystem::path& path);

/// The whole of a text file. kNoInput if it is not there or may not be read, kBadData above `most_bytes`.
Result<std::string> read_text(const std::filesystem::path& file,
                              std::size_t most_bytes = std::size_t{64} << 20);

/// Writes a file aside (`.partial`), syncs it and renames it into place: after a crash there is the old file
/// or the new one, never half of one. Errors: kCannotCreate, kInputOutput with the system's reason.
Result<void> write_file(const std::filesystem::path& file, std::string_view bytes);

/// Syncs a file or folder to its disk.
Result<void> sync_path(const std::filesystem::path& path);

/// Syncs everything under `folder`, renames it to `target` and syncs the parent: a folder that is there is
/// complete. Fails with kCannotCreate if `target` exists.
Result<void> publish_folder(const std::filesystem::path& folder, const std::filesystem::path& target);

/// Makes `folder` and its parents and proves that files can be made in it.
Result<void> make_writable_folder(const std::filesystem::path& folder);

/// A folder aside that becomes `target`. Unless it is published it goes again, with the parents made for it.
class PartialFolder {
 public:
  /// Its path is beside `target`, hidden, and of this process alone; nothing is made yet.
  explicit PartialFolder(const std::filesystem::path& target);
  ~PartialFolder();
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// publish_folder() to the target.
  Result<void> publish();

 private:
  std::filesystem::path target_, path_;
  std::vector<std::filesystem::path> made_;
};

/// SHA-256 of a file's bytes as 64 hexadecimal digits, read in blocks.
Result<std::string> sha256_of_file(const std::filesystem::path& file);

/// Bytes free for this user on the disk that holds `path` or its nearest existing parent.
std::uint64_t free_disk_bytes(const std::filesystem::path& path);
/// Whether both lie on one disk, or their nearest parents that are there, as far as the system tells disks
/// apart.
bool are_on_one_disk(const std::filesystem::path& a, const std::filesystem::path& b);
/// Bytes of memory the system could hand out now without swapping; 0 where it does not say.
std::uint64_t available_memory_bytes();
/// The most memory this process has held at once, in bytes.
std::uint64_t peak_memory_bytes();

/// "No space left on device" and the like for an errno value.
std::string system_reason(int error_number);
/// The error of a file that cannot be opened for reading, from errno.
Error cannot_read(const std::filesystem::path& file, int error_number);
/// What lets this user open a device: the command that joins the group which owns it.
std::string remedy_of_access(const std::filesystem::path& device);
/// The error of an output that could not be written, from errno: kCannotCreate or kInputOutput.
Error cannot_write(const std::filesystem::path& file, int error_number);

}  // namespace weft
