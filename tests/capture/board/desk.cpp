// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/board/desk.h"

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <utility>

#include "virtual_rig/terminal/modem_lines.h"
#include "virtual_rig/terminal/port_name.h"
#include "virtual_rig/terminal/usb_terminal.h"

namespace weft::test {
namespace {

std::filesystem::path new_folder() {
  std::string name = testing::TempDir() + "desk_XXXXXX";
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder " + name);
  return name;
}

std::string firmware_file(const std::string& name) {
  return std::string(name == "firmware" ? WEFT_FIRMWARE : WEFT_FIRMWARE_VERSIONS) + "/" + name + ".elf";
}

template <typename T>
T valid(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(result).value();
}

}  // namespace

Desk::Desk(const std::string& firmware, double bootloader_s, bool usb) : folder_(new_folder()) {
  virtual_rig::VirtualBoardOptions options = {firmware_file(firmware), terminal(), folder_ / "modem",
                                              bootloader_s};
  if (usb) {
    options.usb = {.machine = folder_};
    setenv(virtual_rig::kMachineVariable, folder_.c_str(), 1);
  }
  board_ = valid(virtual_rig::VirtualBoard::start(options, pins_));
  setenv(virtual_rig::kModemVariable, (folder_ / "modem").c_str(), 1);
}

Desk::~Desk() {
  board_.reset();
  unsetenv(virtual_rig::kModemVariable);
  unsetenv(virtual_rig::kMachineVariable);
  std::filesystem::remove_all(folder_);
}

std::string Desk::port() const {
  return virtual_rig::terminal_port_name(terminal());
}

std::unique_ptr<capture::LedBoard> Desk::open() const {
  return valid(capture::LedBoard::open(options()));
}

bool Desk::comes_to_light(const std::vector<int>& leds, double most_s) const {
  unsigned mask = 0;
  for (const int led : leds) mask |= 1U << (led - 1);
  return comes_true(most_s, [&] { return pins_.now() == mask; });
}

double Desk::lit_s_since(virtual_rig::RigClock::time_point then) const {
  const auto seconds = pins_.lit_seconds(then, virtual_rig::RigClock::now(), 10);
  return std::accumulate(seconds.begin(), seconds.end(), 0.0);
}

bool comes_true(double most_s, const std::function<bool()>& condition) {
  const auto end = virtual_rig::RigClock::now() + std::chrono::duration<double>(most_s);
  while (!condition()) {
    if (virtual_rig::RigClock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

LightHolder::LightHolder(const std::string& port, int led, bool preloaded) {
  std::string program = preloaded ? WEFT_HOLD_LIGHT_PLAIN : WEFT_HOLD_LIGHT;
  std::string where = port, which = std::to_string(led);
  std::array<char*, 4> arguments = {program.data(), where.data(), which.data(), nullptr};
  if (preloaded) setenv("LD_PRELOAD", WEFT_TERMINAL_SHIM, 1);
  const int failed = posix_spawn(&process_, program.c_str(), nullptr, nullptr, arguments.data(), environ);
  unsetenv("LD_PRELOAD");
  if (failed != 0) throw std::runtime_error("cannot start " + program);
}

LightHolder::~LightHolder() {
  kill();
}

void LightHolder::kill() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = -1;
}

}  // namespace weft::test
