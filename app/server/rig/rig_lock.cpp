// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/rig_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "app/server/http/http_guard.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

constexpr const char* kLock = "lock";
constexpr const char* kAddress = "address";
constexpr const char* kToken = "token";
constexpr std::filesystem::perms kForAll = static_cast<std::filesystem::perms>(0755);
constexpr mode_t kReadByAll = 0644;
constexpr std::size_t kMostLockBytes = 4096;

std::string first_line(const std::filesystem::path& file) {
  const Result<std::string> text = read_text(file, kMostLockBytes);
  return text ? text->substr(0, text->find('\n')) : "";
}

/// What a locked byte of the lock file says. Unlike flock() such a lock can be asked about without being
/// taken: who looks whether there is an owner must not keep one from starting.
enum class Says : off_t { kOwned, kAddressHolds };

struct flock byte_of(Says says) {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(says);
  lock.l_len = 1;
  return lock;
}

std::string owner_of(const std::filesystem::path& path) {
  struct stat about = {};
  if (stat(path.c_str(), &about) != 0) return "another user";
  const passwd* const user = getpwuid(about.st_uid);
  return user == nullptr ? fmt::format("user {}", about.st_uid) : std::string(user->pw_name);
}

/// The error of a state folder that does not let this user in.
Error kept_out(const std::filesystem::path& folder) {
  struct stat about = {};
  if (stat(folder.c_str(), &about) == 0 && about.st_uid == geteuid()) return cannot_write(folder, EACCES);
  const std::string owner = owner_of(folder);
  return {
      ErrorKind::kCannotCreate, "a daemon of another user owns this rig", folder.string(),
      fmt::format("its state belongs to {}, and no daemon of {} answers this user", owner, owner),
      fmt::format("have {} run weft serve, and scan through it; or run this command as {}", owner, owner)};
}

}  // namespace

std::filesystem::path state_folder(const capture::Rig& rig) {
  if (!rig.daemon.state.empty()) return rig.daemon.state;
  return rig.folder() / (rig.name + ".state");
}

Result<RigLock> RigLock::take(const capture::Rig& rig) {
  const std::filesystem::path folder = state_folder(rig), path = folder / kLock;
  if (Result<void> made = make_writable_folder(folder); !made) {
    const bool is_denied = ::faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) != 0 && errno == EACCES;
    return is_denied ? kept_out(folder) : std::move(made).error();
  }
  std::error_code not_ours;
  std::filesystem::permissions(folder, kForAll, std::filesystem::perm_options::add, not_ours);
  Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kReadByAll));
  if (!file) return errno == EACCES ? kept_out(folder) : cannot_write(path, errno);
  static_cast<void>(fchmod(file.get(), kReadByAll));
  struct flock owned = byte_of(Says::kOwned);
  if (fcntl(file.get(), F_OFD_SETLK, &owned) != 0) {
    if (errno != EAGAIN && errno != EACCES) return cannot_write(path, errno);
    const std::string pid = first_line(path);
    return Error{
        ErrorKind::kTryAgain, "the rig is in use", rig.name,
        fmt::format("process {} owns it (lock {})", pid.empty() ? "of another user" : pid, path.string()),
        "use that daemon, or end it first"};
  }
  const std::string pid = fmt::format("{}\n", getpid());
  if (ftruncate(file.get(), 0) != 0 || pwrite(file.get(), pid.data(), pid.size(), 0) < 0) {
    return cannot_write(path, errno);
  }
  return RigLock(std::move(file), folder);
}

RigLock::~RigLock() {
  std::error_code ignored;
  if (!file_) return;
  for (const char* const name : {kAddress, kToken}) std::filesystem::remove(folder_ / name, ignored);
}

Result<void> RigLock::publish(const std::string& address, const std::string& own_token) {
  const std::filesystem::path token = folder_ / kToken, place = folder_ / kAddress;
  std::error_code ignored;
  std::filesystem::remove(token, ignored);  // of one that was killed
  if (!own_token.empty()) {
    const Descriptor file(token, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
    if (!file || write(file.get(), own_token.data(), own_token.size()) < 0) return cannot_write(token, errno);
  }
  if (Result<void> written = write_file(place, address + "\n"); !written) return written;
  if (chmod(place.c_str(), kReadByAll) != 0) return cannot_write(place, errno);
  struct flock holds = byte_of(Says::kAddressHolds);
  if (fcntl(file_.get(), F_OFD_SETLK, &holds) != 0) return cannot_write(folder_ / kLock, errno);
  return {};
}

Result<std::optional<std::string>> address_of_owner(const capture::Rig& rig) {
  const std::filesystem::path folder = state_folder(rig);
  const Descriptor file(open((folder / kLock).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!file && errno == EACCES) return kept_out(folder);
  struct flock holds = byte_of(Says::kAddressHolds);
  if (!file || fcntl(file.get(), F_OFD_GETLK, &holds) != 0 || holds.l_type == F_UNLCK) {
    return std::optional<std::string>();
  }
  const std::string address = first_line(folder / kAddress);
  return address.empty() ? std::nullopt : std::optional(address);
}

Result<std::string> token_of_owner(const capture::Rig& rig) {
  if (!rig.daemon.token.empty()) return read_token(rig.daemon.token);
  const std::filesystem::path token = state_folder(rig) / kToken;
  if (!is_there(token)) return std::string();
  if (::faccessat(AT_FDCWD, token.c_str(), R_OK, AT_EACCESS) == 0) return read_token(token);
  return Error{ErrorKind::kTryAgain, "the rig is in use", rig.name,
               fmt::format("a scan of {} runs on it", owner_of(token)), "wait for its end"};
}

}  // namespace weft::app
