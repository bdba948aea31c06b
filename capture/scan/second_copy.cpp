// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/second_copy.h"

#include <algorithm>

#include "capture/scan/journal.h"
#include "core/files.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

bool are_same_frames(const Session& a, const Session& b) {
  return std::ranges::equal(a.shots, b.shots, {}, &Shot::sha256, &Shot::sha256);
}

Result<void> copy_verified(const fs::path& file, const fs::path& twin) {
  std::error_code failed;
  fs::copy_file(file, twin, failed);
  if (failed) return cannot_write(twin, failed.value());
  if (Result<void> synced = sync_path(twin); !synced) return synced;
  const Result<std::string> ours = sha256_of_file(file), theirs = sha256_of_file(twin);
  if (!ours) return ours.error();
  if (!theirs) return theirs.error();
  if (*ours == *theirs) return {};
  return Error{ErrorKind::kInputOutput, "copy differs from its session", twin.string(),
               "its SHA-256 is another", "check that disk"};
}

/// Files and folders below `from`.
Result<void> copy_tree(const fs::path& from, const fs::path& to) {
  if (Result<void> made = make_writable_folder(to); !made) return made;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(from, failed)) {
    const fs::path twin = to / entry.path().filename();
    const bool is_folder = entry.is_directory(failed);
    if (failed) break;
    if (Result<void> done = is_folder ? copy_tree(entry.path(), twin) : copy_verified(entry.path(), twin);
        !done) {
      return done;
    }
  }
  return failed ? Result<void>(cannot_read(from, failed.value())) : Result<void>();
}

}  // namespace

Result<void> copy_session(const Session& session, const fs::path& folder) {
  const fs::path target = folder / session.folder.filename();
  if (const Result<Session> there = read_session(target);
      there && there->state == session.state && are_same_frames(*there, session)) {
    return {};
  }
  remove_abandoned(target);
  PartialFolder copy(target);
  for (const char* part : {"raw", "calibration"}) {
    if (!is_there(session.folder / part)) continue;
    if (Result<void> copied = copy_tree(session.folder / part, copy.path() / part); !copied) return copied;
  }
  Session twin = session;
  twin.folder = copy.path();
  if (Result<void> written = write_session(twin); !written) return written;
  return copy.publish();
}

}  // namespace weft::capture
