// SPDX-License-Identifier: Apache-2.0
#include "solve/session/session_lock.h"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>

#include "core/base/files.h"

namespace weft::solve {

Result<Descriptor> lock_session(const std::filesystem::path& folder) {
  Descriptor lock(folder, O_RDONLY | O_DIRECTORY);
  if (!lock) return cannot_read(folder, errno);
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) == 0) return lock;
  return Error{ErrorKind::kTryAgain, "session is being written", folder.string(),
               "a scan or another edit holds its lock", "wait until it has ended"};
}

}  // namespace weft::solve
