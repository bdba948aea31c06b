// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "capture/rig.h"
#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace weft::app {

/// The folder of what a daemon of this rig leaves: rig.daemon.state, or NAME.state beside the rig file.
/// Whatever the umask, all users may enter it and read the lock and the address in it; the token is its
/// owner's alone.
std::filesystem::path state_folder(const capture::Rig& rig);

/// Only one process on this machine owns a rig: the one that holds the lock in its state folder. The system
/// takes it back when the process ends, however it ends.
class RigLock {
 public:
  /// kTryAgain, naming the process, where another one has it; kCannotCreate where the folder is another
  /// user's.
  static Result<RigLock> take(const capture::Rig& rig);
  RigLock(RigLock&&) = default;
  RigLock& operator=(RigLock&&) = default;
  ~RigLock();

  /// Tells clients where the owner answers (`state`/address) and, to those of this user, a token of its own
  /// (`state`/token); empty: it has none. Both are removed with the lock.
  Result<void> publish(const std::string& address, const std::string& own_token);
  const std::filesystem::path& folder() const { return folder_; }

 private:
  RigLock(Descriptor file, std::filesystem::path folder)
      : file_(std::move(file)), folder_(std::move(folder)) {}
  Descriptor file_;
  std::filesystem::path folder_;
};

/// Where the process that owns this rig answers ("http://127.0.0.1:8470"); nothing where none does.
/// kCannotCreate where the state folder is another user's and keeps that to itself.
Result<std::optional<std::string>> address_of_owner(const capture::Rig& rig);

/// What the owner of this rig wants to be sent: the rig file's token, else the owner's own; empty: none.
/// Errors: those of read_token(), kTryAgain where the owner is a scan of another user.
Result<std::string> token_of_owner(const capture::Rig& rig);

}  // namespace weft::app
