// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/second_copy.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "capture/scan/journal.h"
#include "core/base/descriptor.h"
#include "core/base/files.h"
#include "core/base/text.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

bool are_same_frames(const Session& a, const Session& b) {
  return std::ranges::equal(a.shots, b.shots, {}, &Shot::sha256, &Shot::sha256);
}

bool holds(const Session& session, const Shot& shot) {
  return std::ranges::any_of(
      session.shots, [&](const Shot& each) { return each.sha256 == shot.sha256 && each.file == shot.file; });
}

/// Whether `twin` is what the session was before shots were taken again.
bool is_of_before(const Session& twin, const Session& session) {
  return std::ranges::all_of(twin.shots, [&](const Shot& shot) { return holds(session, shot); });
}

/// Reads a file back from its disk: what the system holds of it in memory is written and let go first.
Result<void> verify(const fs::path& file, const std::string& sha256) {
  const Descriptor on_disk(file, O_RDONLY);
  if (!on_disk) return cannot_read(file, errno);
  if (::fsync(on_disk.get()) != 0) return cannot_write(file, errno);
  ::posix_fadvise(on_disk.get(), 0, 0, POSIX_FADV_DONTNEED);
  const Result<std::string> digest = sha256_of_file(file);
  if (!digest) return digest.error();
  if (*digest == sha256) return {};
  return Error{ErrorKind::kInputOutput, "copy differs from its session", file.string(),
               "its SHA-256 is not that of the frame as it was received",
               "check both disks, and move the copy away before the next try"};
}

Result<void> copy_verified(const fs::path& file, const fs::path& twin, const std::string& sha256) {
  std::error_code failed;
  fs::create_directories(twin.parent_path(), failed);
  if (!failed) fs::copy_file(file, twin, failed);
  return failed ? Result<void>(cannot_write(twin, failed.value())) : verify(twin, sha256);
}

Result<void> copy_frames(const Session& session, const Session& twin) {
  for (const Shot& shot : session.shots) {
    if (Result<void> done = copy_verified(session.path_of(shot), twin.path_of(shot), shot.sha256); !done)
      return done;
  }
  return {};
}

Result<void> copy_calibration(const Session& session, const Session& twin) {
  const fs::path from = session.calibration_folder();
  const Result<bool> there = look_for(from);
  if (!there) return there.error();
  if (!*there) return {};
  std::error_code failed;
  for (fs::recursive_directory_iterator entry(from, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    if (entry->is_directory(failed)) continue;
    const Result<std::string> digest = sha256_of_file(entry->path());
    if (!digest) return digest.error();
    const fs::path place = twin.calibration_folder() / entry->path().lexically_relative(from);
    if (Result<void> done = copy_verified(entry->path(), place, *digest); !done) return done;
  }
  return failed ? Result<void>(cannot_read(from, failed.value())) : Result<void>();
}

/// The session's document comes last: a copy that is cut short is the one of before, with files more.
Result<void> add_frames(const Session& session, const Session& there) {
  Session twin = session;
  twin.folder = there.folder;
  for (const Shot& shot : session.shots) {
    if (holds(there, shot)) continue;
    std::error_code ignored;
    std::filesystem::remove(twin.path_of(shot), ignored);
    if (Result<void> done = copy_verified(session.path_of(shot), twin.path_of(shot), shot.sha256); !done)
      return done;
  }
  twin.document.erase("copy");
  return write_session(twin);
}

Result<void> verify_frames(const Session& session) {
  for (const Shot& shot : session.shots) {
    if (Result<void> same = verify(session.path_of(shot), shot.sha256); !same) return same;
  }
  return {};
}

}  // namespace

fs::path place_of_copy(const Session& session, const fs::path& folder) {
  std::string rig = plain_name(session.rig);
  if (rig.empty() || rig.starts_with('.')) rig.insert(0, "_");
  return folder / rig / session.folder.filename();
}

Result<void> copy_session(const Session& session, const fs::path& folder) {
  const fs::path target = place_of_copy(session, folder);
  if (const Result<Session> there = read_session(target); there && there->state == session.state) {
    if (are_same_frames(*there, session)) return verify_frames(*there);
    if (is_of_before(*there, session)) return add_frames(session, *there);
  }
  remove_abandoned(target);
  PartialFolder aside(target);
  if (Result<void> made = make_writable_folder(aside.path()); !made) return made;
  Session twin = session;
  twin.folder = aside.path();
  if (Result<void> copied = copy_frames(session, twin); !copied) return copied;
  if (Result<void> copied = copy_calibration(session, twin); !copied) return copied;
  twin.document.erase("copy");
  if (Result<void> written = write_session(twin); !written) return written;
  return aside.publish();
}

Json record_of_copy(const fs::path& folder, const Result<void>& copied) {
  Json record = {{"to", fs::absolute(folder).string()}, {"state", copied ? "verified" : "missing"}};
  if (!copied) record["why"] = copied.error().message();
  return record;
}

Result<fs::path> copy_later(const fs::path& folder, fs::path to) {
  Result<Session> session = read_session(absolute_folder(folder));
  if (!session) return std::move(session).error();
  if (session->state != "complete") {
    return Error{ErrorKind::kTryAgain, "the session is not finished", folder.string(),
                 "a copy is made of what does not change any more", "finish it with weft scan first"};
  }
  if (const Json record = session->document.value("copy", Json()); to.empty() && record.is_object()) {
    to = record.value("to", "");
  }
  if (to.empty()) {
    return Error{ErrorKind::kUsage, "nothing says where the copy belongs", folder.string(),
                 "it was scanned without a second disk", "name a folder on another disk: --to FOLDER"};
  }
  const Result<void> copied = copy_session(*session, to);
  session->document["copy"] = record_of_copy(to, copied);
  if (Result<void> noted = write_session(*session); copied && !noted) return noted.error();
  if (!copied) return copied.error();
  return place_of_copy(*session, to);
}

std::optional<std::string> warning_of_one_disk(const fs::path& sessions, const fs::path& folder) {
  if (!are_on_one_disk(sessions, folder)) return std::nullopt;
  return fmt::format(
      "the second copy is no help if a disk fails: {} is on the disk of the sessions, or its own is not "
      "mounted",
      folder.string());
}

}  // namespace weft::capture
