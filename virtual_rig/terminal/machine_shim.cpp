// SPDX-License-Identifier: Apache-2.0
// USB terminals of a machine that is not there, for the unchanged libserialport: what a program looks for
// among the machine's own it finds in the folder that WEFT_TERMINAL_MACHINE names (usb_terminal.h), and only
// there. Loaded or linked as terminal_shim.cpp is.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "virtual_rig/terminal/usb_terminal.h"

#pragma GCC visibility push(default)

namespace {

constexpr std::array<std::string_view, 5> kOfTerminals = {"/dev/ttyACM", "/dev/weft-led", "/dev/serial/",
                                                          "/sys/class/tty", "/sys/dev/char/"};

/// The path to take for a path.
class Path {
 public:
  explicit Path(const char* path) : path_(path) {
    const char* const machine = std::getenv(weft::virtual_rig::kMachineVariable);
    if (machine == nullptr || path == nullptr) return;
    for (const std::string_view prefix : kOfTerminals) {
      if (std::string_view(path).starts_with(prefix))
        path_ = (in_machine_ = std::string(machine) + path).c_str();
    }
  }
  operator const char*() const { return path_; }  // NOLINT(google-explicit-constructor)

 private:
  std::string in_machine_;
  const char* path_;
};

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const bool makes = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  const mode_t mode = makes ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  static auto* const real = next<int(const char*, int, ...)>("open");
  return real(Path(path), flags, mode);
}

// What open() and lstat() are called in programs that were built with checks, or for an older C library.
int __open_2(const char* path, int flags) {
  return open(path, flags);
}

int lstat(const char* path, struct stat* facts) noexcept {
  static auto* const real = next<int(const char*, struct stat*)>("lstat");
  return real(Path(path), facts);
}

int __lxstat(int, const char* path, struct stat* facts) noexcept {
  return lstat(path, facts);
}

ssize_t readlink(const char* path, char* target, size_t size) noexcept {
  static auto* const real = next<decltype(readlink)>("readlink");
  return real(Path(path), target, size);
}

FILE* fopen(const char* path, const char* mode) {
  static auto* const real = next<decltype(fopen)>("fopen");
  return real(Path(path), mode);
}

DIR* opendir(const char* path) {
  static auto* const real = next<decltype(opendir)>("opendir");
  return real(Path(path));
}

}  // extern "C"

#pragma GCC visibility pop
