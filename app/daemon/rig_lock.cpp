// SPDX-License-Identifier: Apache-2.0
#include "app/daemon/rig_lock.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "core/files.h"

namespace weft::app {
namespace {

constexpr const char* kLock = "lock";
constexpr const char* kAddress = "address";
constexpr std::size_t kMostBytes = 4096;

std::string first_line(const std::filesystem::path& file) {
  const Result<std::string> text = read_text(file, kMostBytes);
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

}  // namespace

std::filesystem::path state_folder(const capture::Rig& rig) {
  if (!rig.daemon.state.empty()) return rig.daemon.state;
  return rig.file.parent_path() / (rig.name + ".state");
}

Result<RigLock> RigLock::take(const capture::Rig& rig) {
  const std::filesystem::path folder = state_folder(rig), path = folder / kLock;
  if (Result<void> made = make_writable_folder(folder); !made) return std::move(made).error();
  Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (!file) return cannot_write(path, errno);
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
  if (file_) std::filesystem::remove(folder_ / kAddress, ignored);
}

Result<void> RigLock::publish_address(const std::string& address) {
  if (Result<void> written = write_file(folder_ / kAddress, address + "\n"); !written) return written;
  struct flock holds = byte_of(Says::kAddressHolds);
  if (fcntl(file_.get(), F_OFD_SETLK, &holds) != 0) return cannot_write(folder_ / kLock, errno);
  return {};
}

std::optional<std::string> address_of_owner(const capture::Rig& rig) {
  const std::filesystem::path folder = state_folder(rig);
  const Descriptor file(open((folder / kLock).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  struct flock holds = byte_of(Says::kAddressHolds);
  if (!file || fcntl(file.get(), F_OFD_GETLK, &holds) != 0 || holds.l_type == F_UNLCK) return std::nullopt;
  const std::string address = first_line(folder / kAddress);
  return address.empty() ? std::nullopt : std::optional(address);
}

}  // namespace weft::app
