// SPDX-License-Identifier: Apache-2.0
#include "core/base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/partial_name.h"
#include "core/base/sha256.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

fs::path parent_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// The path itself, or its nearest parent that is there.
fs::path existing_parent(const fs::path& path) {
  std::error_code failed;
  fs::path existing = fs::absolute(path, failed);
  while (!fs::exists(existing, failed) && existing.has_relative_path()) existing = existing.parent_path();
  return existing;
}

}  // namespace

fs::path absolute_folder(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

Result<bool> look_for(const fs::path& path) {
  std::error_code failed;
  const fs::file_status status = fs::symlink_status(path, failed);
  if (fs::status_known(status)) return fs::exists(status);
  return Error{ErrorKind::kInputOutput, "cannot see what is there", path.string(), failed.message(),
               "bring its disk back, or give this user the right to see it, then run the same command again"};
}

std::string system_reason(int error_number) {
  return std::strerror(error_number);
}

std::string remedy_of_access(const fs::path& device) {
  struct stat facts {};
  const bool known = ::stat(device.c_str(), &facts) == 0;
  const struct group* owner = known && facts.st_gid != 0 ? ::getgrgid(facts.st_gid) : nullptr;
  if (owner != nullptr && (facts.st_mode & S_IRGRP) != 0 && (facts.st_mode & S_IWGRP) != 0)
    return fmt::format("run `sudo usermod -aG {} $USER` and log in again", owner->gr_name);
  return fmt::format(
      "no group may open it: install weft's udev rules (docs/rig.md), or run `sudo chmod a+rw {}`, "
      "which lasts until it is plugged out",
      device.string());
}

Error cannot_read(const fs::path& file, int error_number) {
  return {ErrorKind::kNoInput, "cannot read", file.string(), system_reason(error_number),
          error_number == EACCES ? "give this user the right to read it" : "check the path"};
}

Error cannot_write(const fs::path& file, int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return {ErrorKind::kInputOutput, "cannot write", file.string(), system_reason(error_number),
              "free disk space or choose another disk with -o, then run the same command again"};
    case ENAMETOOLONG:  // sockets end at 107 bytes with their folder
      return {ErrorKind::kCannotCreate, "cannot create", file.string(), system_reason(error_number),
              "choose a shorter name, or a folder whose path is shorter"};
    case EACCES:
    case EPERM:
    case EROFS:
    case ENOENT:
    case ENOTDIR:
    case EISDIR:
    case ELOOP:
    case EEXIST:
    case ENOTEMPTY:
      return {ErrorKind::kCannotCreate, "cannot create", file.string(), system_reason(error_number),
              "choose a folder that this user may write to"};
    default:
      return {ErrorKind::kInputOutput, "cannot write", file.string(), system_reason(error_number),
              "check the disk and its cable"};
  }
}

Result<std::string> read_text(const fs::path& file, std::size_t most_bytes) {
  const Descriptor in(file, O_RDONLY);
  if (!in) return cannot_read(file, errno);
  struct stat info = {};
  if (fstat(in.get(), &info) != 0) return cannot_read(file, errno);
  if (S_ISDIR(info.st_mode)) return cannot_read(file, EISDIR);
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  for (;;) {
    const ssize_t n = ::read(in.get(), block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return cannot_read(file, errno);
    if (n == 0) return text;
    text.append(block.data(), static_cast<std::size_t>(n));
    if (text.size() > most_bytes) {
      return Error{ErrorKind::kBadData, "file is too large for what it should be", file.string(),
                   fmt::format("over {} bytes", most_bytes), "check that it is the file you mean"};
    }
  }
}

Result<void> write_file(const fs::path& file, std::string_view bytes) {
  fs::path aside = file;
  aside += ".partial";
  {
    const Descriptor out(aside, O_WRONLY | O_CREAT | O_TRUNC);
    if (!out) return cannot_write(file, errno);
    if (!write_all(out.get(), bytes) || ::fsync(out.get()) != 0) {
      const int reason = errno;
      ::unlink(aside.c_str());
      return cannot_write(file, reason);
    }
  }
  if (::rename(aside.c_str(), file.c_str()) != 0) {
    const int reason = errno;
    ::unlink(aside.c_str());
    return cannot_write(file, reason);
  }
  return sync_path(parent_of(file));
}

Result<void> sync_path(const fs::path& path) {
  const Descriptor fd(path, O_RDONLY);
  if (!fd || ::fsync(fd.get()) != 0) return cannot_write(path, errno);
  return {};
}

Result<void> publish_folder(const fs::path& folder, const fs::path& target) {
  std::error_code failed;
  for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    if (Result<void> synced = sync_path(entry->path()); !synced) return synced;
  }
  if (failed) return cannot_write(folder, failed.value());
  if (Result<void> synced = sync_path(folder); !synced) return synced;
  // rename() would replace an empty folder in silence.
  if (fs::exists(target, failed)) return cannot_write(target, EEXIST);
  if (::rename(folder.c_str(), target.c_str()) != 0) return cannot_write(target, errno);
  return sync_path(parent_of(target));
}

PartialFolder::PartialFolder(const fs::path& target)
    : target_(absolute_folder(target)),
      path_(parent_of(target_) / partial_name(target_.filename().string())) {
  for (fs::path p = path_.parent_path(); !p.empty() && !is_there(p); p = p.parent_path()) made_.push_back(p);
}

PartialFolder::~PartialFolder() {
  std::error_code ignored;
  if (path_.empty()) return;
  fs::remove_all(path_, ignored);
  for (const fs::path& parent : made_) fs::remove(parent, ignored);
}

Result<void> PartialFolder::publish() {
  Result<void> published = publish_folder(path_, target_);
  if (published) path_.clear();
  return published;
}

Result<void> make_writable_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return cannot_write(folder, failed.value());
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0) return cannot_write(folder, errno);
  return {};
}

Result<std::string> sha256_of_file(const fs::path& file) {
  const Descriptor in(file, O_RDONLY);
  if (!in) return cannot_read(file, errno);
  Sha256 digest;
  std::vector<char> block(std::size_t{1} << 20);
  for (;;) {
    const ssize_t n = ::read(in.get(), block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return cannot_read(file, errno);
    if (n == 0) return digest.hex();
    digest.add(block.data(), static_cast<std::size_t>(n));
  }
}

std::uint64_t free_disk_bytes(const fs::path& path) {
  std::error_code failed;
  const fs::space_info space = fs::space(existing_parent(path), failed);
  return failed ? 0 : space.available;
}

bool are_on_one_disk(const fs::path& a, const fs::path& b) {
  struct stat of_a = {}, of_b = {};
  return ::stat(existing_parent(a).c_str(), &of_a) == 0 && ::stat(existing_parent(b).c_str(), &of_b) == 0 &&
         of_a.st_dev == of_b.st_dev;
}

std::uint64_t available_memory_bytes() {
  std::ifstream info("/proc/meminfo");
  std::string key;
  std::uint64_t kilobytes = 0;
  std::string unit;
  while (info >> key >> kilobytes >> unit) {
    if (key == "MemAvailable:") return kilobytes * 1024;
  }
  return 0;
}

std::uint64_t peak_memory_bytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace weft
