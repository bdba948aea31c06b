// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/terminal/modem_lines.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace weft::virtual_rig {
namespace {

void unmap(ModemLines* lines) {
  munmap(lines, sizeof *lines);
}

/// Null, and errno, where it cannot be mapped.
SharedModemLines map(int file) {
  void* at = mmap(nullptr, sizeof(ModemLines), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  return {at == MAP_FAILED ? nullptr : static_cast<ModemLines*>(at), unmap};
}

}  // namespace

Result<SharedModemLines> make_modem_lines(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool sized = file >= 0 && ftruncate(file, sizeof(ModemLines)) == 0;
  SharedModemLines lines = sized ? map(file) : SharedModemLines(nullptr, unmap);
  const int why = errno;
  if (file >= 0) ::close(file);
  if (!lines) {
    return Error{ErrorKind::kCannotCreate, "the file for modem lines cannot be made", path.string(),
                 std::generic_category().message(why), "choose a folder that can be written"};
  }
  return lines;
}

SharedModemLines open_modem_lines(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  struct stat facts {};
  const bool whole = file >= 0 && fstat(file, &facts) == 0 && facts.st_size >= off_t{sizeof(ModemLines)};
  SharedModemLines lines = whole ? map(file) : SharedModemLines(nullptr, unmap);
  if (file >= 0) ::close(file);
  return lines;
}

}  // namespace weft::virtual_rig
