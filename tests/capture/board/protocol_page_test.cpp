// SPDX-License-Identifier: Apache-2.0
// docs/protocol.md is enough to light LED 3 from a shell: its script, run as it stands there but for the port
// and shorter waits. Nothing else keeps the light on: a shell that stands still for 0.4 s lets it go out.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

#include "capture/board/board_replies.h"
#include "core/base/descriptor.h"
#include "tests/capture/board/desk.h"
#include "tests/core/places.h"

namespace weft::capture {
namespace {

using virtual_rig::RigClock;

/// The script of the page's chapter "Lighting LED 3 from a shell".
std::string script_of_page() {
  std::ifstream page(in_sources("docs/protocol.md"));
  std::string line, script;
  while (std::getline(page, line) && line != "## Lighting LED 3 from a shell") {
  }
  while (std::getline(page, line) && line != "```bash") {
  }
  while (std::getline(page, line) && line != "```") script += line + "\n";
  return script;
}

/// Every one of `from`, of which there must be one at least.
void replace(std::string& script, const std::string& from, const std::string& to) {
  EXPECT_NE(script.find(from), std::string::npos) << "the page's script has no " << from;
  for (std::size_t at = 0; (at = script.find(from, at)) != std::string::npos; at += to.size())
    script.replace(at, from.size(), to);
}

/// What the board says of itself when it is asked through a terminal that nobody resets it by.
std::optional<BoardStatus> status_of(const std::string& terminal) {
  constexpr std::array<std::uint8_t, 6> kStatus = {0xA5, 0x00, 0x0B, 0x04, 0xE2, 0x50};
  const Descriptor port(open(terminal.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (write(port.get(), kStatus.data(), kStatus.size()) != static_cast<ssize_t>(kStatus.size())) return {};
  ReplyParser parser;
  pollfd readable = {port.get(), POLLIN, 0};
  std::uint8_t byte = 0;
  while (poll(&readable, 1, 2000) > 0 && read(port.get(), &byte, 1) == 1) {
    const auto reply = parser.take(byte);
    if (!reply || reply->sequence != kStatus[2]) continue;
    const auto status = status_in(*reply, terminal);
    return status ? std::optional(*status) : std::nullopt;
  }
  return {};
}

TEST(ProtocolPage, LightsLed3FromAShell) {
  test::Desk desk;
  std::string script = script_of_page();
  replace(script, "/dev/ttyACM0", desk.terminal().string());
  replace(script, "sleep 2 ", "sleep 0.3 ");
  replace(script, "  sleep 0.2\n", "  sleep 0.05\n");
  replace(script, "$(seq 50)", "$(seq 32)");
  const std::filesystem::path file = desk.terminal().parent_path() / "light.sh";
  std::ofstream(file) << script;
  const RigClock::time_point begin = RigClock::now();
  EXPECT_EQ(std::system(("bash -e " + file.string()).c_str()), 0) << script;

  const std::optional<BoardStatus> status = status_of(desk.terminal().string());
  ASSERT_TRUE(status);
  EXPECT_EQ(status->lit, std::vector<int>());
  EXPECT_NE(status->dark, WentDark::kNeverLit);
  EXPECT_EQ(status->bad_frames, 0);
  const std::vector<double> lit_s = desk.pins().lit_seconds(begin, RigClock::now(), 10);
  for (std::size_t i = 0; i < lit_s.size(); ++i) {
    if (i + 1 == 3) {
      EXPECT_GT(lit_s[i], 1.4) << "32 rounds of 0.05 s, longer than the dead-man timer alone would keep it";
    } else {
      EXPECT_EQ(lit_s[i], 0) << "LED " << i + 1;
    }
  }
}

}  // namespace
}  // namespace weft::capture
