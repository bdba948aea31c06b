// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/board/pseudo_terminal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace weft::virtual_rig {
namespace {

Error cannot_make(const std::filesystem::path& link, int error_number) {
  return {ErrorKind::kCannotCreate, "the virtual board's terminal cannot be made", link.string(),
          std::generic_category().message(error_number), "choose a folder that can be written"};
}

void make_raw(int terminal) {
  termios settings = {};
  tcgetattr(terminal, &settings);
  cfmakeraw(&settings);
  cfsetspeed(&settings, B115200);
  tcsetattr(terminal, TCSANOW, &settings);
}

/// Names the terminal by the link in one step, so that nobody finds half of it.
bool make_link(const std::string& terminal, const std::filesystem::path& link) {
  const std::string aside = link.string() + ".partial";
  unlink(aside.c_str());
  return symlink(terminal.c_str(), aside.c_str()) == 0 && rename(aside.c_str(), link.c_str()) == 0;
}

}  // namespace

Result<std::unique_ptr<PseudoTerminal>> PseudoTerminal::make(const std::filesystem::path& link) {
  const int board_end = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (board_end < 0) return cannot_make(link, errno);
  std::array<char, 64> name = {};
  const bool named = grantpt(board_end) == 0 && unlockpt(board_end) == 0 &&
                     ptsname_r(board_end, name.data(), name.size()) == 0;
  const int host_end = named ? open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC) : -1;
  struct stat facts {};
  if (host_end < 0 || fstat(host_end, &facts) != 0 || !make_link(name.data(), link)) {
    const int why = errno;
    if (host_end >= 0) close(host_end);
    close(board_end);
    return cannot_make(link, why);
  }
  make_raw(host_end);
  return std::unique_ptr<PseudoTerminal>(new PseudoTerminal(link, board_end, host_end, facts.st_rdev));
}

PseudoTerminal::~PseudoTerminal() {
  unlink(link_.c_str());
  close(host_end_);
  close(board_end_);
}

bool PseudoTerminal::is_at_115200_baud() const {
  termios settings = {};
  return tcgetattr(board_end_, &settings) == 0 && cfgetospeed(&settings) == B115200;
}

std::size_t PseudoTerminal::read(std::span<std::uint8_t> bytes) const {
  const ssize_t count = ::read(board_end_, bytes.data(), bytes.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

void PseudoTerminal::write(std::span<const std::uint8_t> bytes) const {
  [[maybe_unused]] const ssize_t written = ::write(board_end_, bytes.data(), bytes.size());
}

}  // namespace weft::virtual_rig
