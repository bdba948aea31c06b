// SPDX-License-Identifier: Apache-2.0
// A full disk, for a program that this is loaded into (LD_PRELOAD=libweft_disk_shim.so): while the file that
// WEFT_FULL_DISK names is there, no file takes more than the first half of what is written to it next, and
// the system says that no room is left. What the program says to its terminal is not held up.
#include <dlfcn.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace {

bool is_full() {
  const int kept = errno;
  const char* const flag = std::getenv("WEFT_FULL_DISK");
  const bool full = flag != nullptr && access(flag, F_OK) == 0;
  errno = kept;
  return full;
}

bool is_refused(int descriptor) {
  struct stat facts {};
  return descriptor > STDERR_FILENO && is_full() && fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode);
}

template <typename Function>
Function* next(const char* name) {
  Function* function = nullptr;
  void* const symbol = dlsym(RTLD_NEXT, name);
  std::memcpy(&function, &symbol, sizeof(function));
  return function;
}

ssize_t no_room() {
  errno = ENOSPC;
  return -1;
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t count) {
  static auto* const real = next<decltype(write)>("write");
  if (!is_refused(descriptor)) return real(descriptor, bytes, count);
  const size_t half = count / 2;
  return half < 4096 ? no_room() : real(descriptor, bytes, half);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static auto* const real = next<decltype(writev)>("writev");
  return is_refused(descriptor) ? no_room() : real(descriptor, parts, count);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t offset) {
  static auto* const real = next<decltype(pwrite64)>("pwrite64");
  return is_refused(descriptor) ? no_room() : real(descriptor, bytes, count, offset);
}

ssize_t sendfile(int out, int in, off_t* offset, size_t count) noexcept {
  static auto* const real = next<decltype(sendfile)>("sendfile");
  return is_refused(out) ? no_room() : real(out, in, offset, count);
}

ssize_t copy_file_range(int in, off64_t* in_offset, int out, off64_t* out_offset, size_t count,
                        unsigned flags) {
  static auto* const real = next<decltype(copy_file_range)>("copy_file_range");
  return is_refused(out) ? no_room() : real(in, in_offset, out, out_offset, count, flags);
}

int statvfs(const char* path, struct statvfs* facts) noexcept {
  static auto* const real = next<int(const char*, struct statvfs*)>("statvfs");
  const int done = real(path, facts);
  if (done == 0 && is_full()) facts->f_bavail = facts->f_bfree = 0;
  return done;
}

}  // extern "C"
