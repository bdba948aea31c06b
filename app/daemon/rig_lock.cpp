// SPDX-License-Identifier: Apache-2.0
#include "app/daemon/rig_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

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
  if (flock(file.number(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return cannot_write(path, errno);
    const std::string pid = first_line(path);
    return Error{
        ErrorKind::kTryAgain, "the rig is in use", rig.name,
        fmt::format("process {} owns it (lock {})", pid.empty() ? "of another user" : pid, path.string()),
        "use that daemon, or end it first"};
  }
  const std::string pid = fmt::format("{}\n", getpid());
  if (ftruncate(file.number(), 0) != 0 || pwrite(file.number(), pid.data(), pid.size(), 0) < 0) {
    return cannot_write(path, errno);
  }
  std::error_code ignored;
  std::filesystem::remove(folder / kAddress, ignored);  // of an owner that was killed
  return RigLock(std::move(file), folder);
}

RigLock::~RigLock() {
  std::error_code ignored;
  if (file_) std::filesystem::remove(folder_ / kAddress, ignored);
}

Result<void> RigLock::publish_address(const std::string& address) {
  return write_file(folder_ / kAddress, address + "\n");
}

std::optional<std::string> address_of_owner(const capture::Rig& rig) {
  const std::filesystem::path folder = state_folder(rig);
  const Descriptor file(open((folder / kLock).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!file || flock(file.number(), LOCK_SH | LOCK_NB) == 0) return std::nullopt;
  const std::string address = first_line(folder / kAddress);
  return address.empty() ? std::nullopt : std::optional(address);
}

}  // namespace weft::app
