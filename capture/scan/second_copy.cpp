// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/second_copy.h"

#include "core/files.h"

namespace weft::capture {

namespace fs = std::filesystem;

Result<void> copy_session(const fs::path& session, const fs::path& folder) {
  const fs::path name = session.has_filename() ? session.filename() : session.parent_path().filename();
  PartialFolder copy(folder / name);
  if (Result<void> made = make_writable_folder(copy.path()); !made) return made;
  std::error_code failed;
  fs::copy(session, copy.path(), fs::copy_options::recursive, failed);
  if (failed) return cannot_write(folder / name, failed.value());
  for (const auto& entry : fs::recursive_directory_iterator(session)) {
    if (!entry.is_regular_file()) continue;
    const fs::path twin = copy.path() / fs::relative(entry.path(), session);
    if (Result<void> synced = sync_path(twin); !synced) return synced;
    const Result<std::string> ours = sha256_of_file(entry.path()), theirs = sha256_of_file(twin);
    if (!ours) return ours.error();
    if (!theirs) return theirs.error();
    if (*ours != *theirs) {
      return Error{ErrorKind::kInputOutput, "copy differs from its session", twin.string(),
                   "its SHA-256 is another", "check that disk"};
    }
  }
  return copy.publish();
}

}  // namespace weft::capture
