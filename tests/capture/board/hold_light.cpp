// SPDX-License-Identifier: Apache-2.0
// hold_light PORT LED: lights a LED and keeps it lit until it is killed, 30 s at most.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "capture/board/led_board.h"

int main(int count, char** arguments) {
  if (count != 3) return 64;
  const auto board = weft::capture::LedBoard::open({arguments[1]});
  if (!board) {
    std::fprintf(stderr, "%s\n", board.error().message().c_str());
    return 69;
  }
  const int led = static_cast<int>(std::strtol(arguments[2], nullptr, 10));
  if (const auto lit = (*board)->light({&led, 1}, 40); !lit) {
    std::fprintf(stderr, "%s\n", lit.error().message().c_str());
    return 69;
  }
  std::this_thread::sleep_for(std::chrono::seconds(30));
  return 0;
}
