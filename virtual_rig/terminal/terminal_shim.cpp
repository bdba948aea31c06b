// SPDX-License-Identifier: Apache-2.0
// Modem lines for the pseudo-terminal of a virtual board, so that the unchanged libserialport opens it.
// TIOCEXCL is noted and goes no further: the pseudo-terminal would stay closed to all after the host's death,
// for its board has it open too. This is loaded before the C library (LD_PRELOAD=libweft_terminal_shim.so) or
// linked into a program. It answers for the terminals that the files of WEFT_TERMINAL_MODEM name, a colon
// between two, and for nothing else.
#include <dlfcn.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "virtual_rig/terminal/modem_lines.h"

namespace {

using weft::virtual_rig::ModemLines;
using weft::virtual_rig::SharedModemLines;

bool is_modem_request(unsigned long request) {
  return request == TIOCMGET || request == TIOCMSET || request == TIOCMBIS || request == TIOCMBIC;
}

/// The lines of this terminal; null where it is no terminal of ours.
SharedModemLines lines_of(int descriptor) {
  struct stat facts {};
  const bool is_terminal = fstat(descriptor, &facts) == 0 && S_ISCHR(facts.st_mode);
  const char* const said = std::getenv(weft::virtual_rig::kModemVariable);
  std::string_view files = is_terminal && said ? said : "";
  SharedModemLines lines(nullptr, [](ModemLines*) {});
  while (!files.empty()) {
    const std::size_t end = std::min(files.find(':'), files.size());
    lines = weft::virtual_rig::open_modem_lines(files.substr(0, end));
    if (lines && lines->terminal.load() == facts.st_rdev) return lines;
    files.remove_prefix(std::min(end + 1, files.size()));
  }
  lines.reset();
  return lines;
}

void set(ModemLines& lines, std::uint32_t wanted) {
  const std::uint32_t before = lines.lines.exchange(wanted);
  if ((wanted & ~before & TIOCM_DTR) != 0) ++lines.dtr_rises;
}

void answer(ModemLines& modem, unsigned long request, int* argument) {
  const std::uint32_t lines = modem.lines.load();
  const auto bits = static_cast<std::uint32_t>(*argument);
  if (request == TIOCMGET) *argument = static_cast<int>(lines | TIOCM_CTS | TIOCM_DSR | TIOCM_CAR);
  if (request == TIOCMSET) set(modem, bits & (TIOCM_DTR | TIOCM_RTS));
  if (request == TIOCMBIS) set(modem, lines | bits);
  if (request == TIOCMBIC) set(modem, lines & ~bits);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int ioctl(int descriptor, unsigned long request,
                                                            ...) noexcept {
  std::va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (request == TIOCEXCL) {
    if (const auto lines = lines_of(descriptor)) {
      lines->exclusive = 1;
      return 0;
    }
  }
  if (is_modem_request(request) && argument != nullptr) {
    if (const auto lines = lines_of(descriptor)) {
      answer(*lines, request, static_cast<int*>(argument));
      return 0;
    }
  }
  static const auto real = reinterpret_cast<int (*)(int, unsigned long, ...)>(dlsym(RTLD_NEXT, "ioctl"));
  return real(descriptor, request, argument);
}
