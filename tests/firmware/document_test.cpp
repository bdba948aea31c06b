// SPDX-License-Identifier: Apache-2.0
// docs/protocol.md shows a conversation byte by byte: "-> " what a host sends, "<- " what the board replies,
// ".. " milliseconds that pass. The firmware is asked for the same.
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/core/places.h"
#include "tests/firmware/requests.h"

namespace weft {
namespace {

using test::Bytes;

/// The bytes a line begins with, up to the first word that is none.
Bytes bytes_in(const std::string& text) {
  Bytes bytes;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (word.size() != 2 || std::isxdigit(word[0]) == 0 || std::isxdigit(word[1]) == 0) break;
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(word, nullptr, 16)));
  }
  return bytes;
}

TEST(ProtocolPage, ShowsTheBytesThatTheFirmwareMakes) {
  std::ifstream page(in_sources("docs/protocol.md"));
  test::BareBoard board;
  board.board.reset_cause = kWeftResetExternal;
  Bytes reply;
  int examples = 0;
  for (std::string line; std::getline(page, line);) {
    const std::string rest = line.substr(std::min<std::size_t>(3, line.size()));
    if (line.starts_with(".. ")) board.wait_ms(std::stoi(rest));
    if (line.starts_with("-> ")) reply = board.hear(bytes_in(rest));
    if (line.starts_with("<- ")) {
      EXPECT_EQ(bytes_in(rest), reply) << line;
      ++examples;
    }
  }
  EXPECT_GE(examples, 8);
}

TEST(ProtocolPage, ShowsFramesForAShellThatTheFirmwareUnderstands) {
  std::ifstream page(in_sources("docs/protocol.md"));
  test::BareBoard board;
  int lit = 0;
  for (std::string line; std::getline(page, line);) {
    const auto begin = line.find("printf '");
    if (begin == std::string::npos) continue;
    const std::string text = line.substr(begin + 8, line.find('\'', begin + 8) - begin - 8);
    Bytes bytes;
    for (std::size_t at = 0; at + 3 < text.size() && text.substr(at, 2) == "\\x"; at += 4) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(at + 2, 2), nullptr, 16)));
    }
    EXPECT_FALSE(board.hear(bytes).empty()) << line;
    lit |= board.lit();
  }
  EXPECT_EQ(lit, 1 << 2) << "the page promises LED 3";
}

}  // namespace
}  // namespace weft
