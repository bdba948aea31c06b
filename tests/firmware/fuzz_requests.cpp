// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes, with any pauses, as what comes over the wire to the LED board's firmware.
// Half of the inputs get whole frames around them, so that commands are reached too. Build it by the `fuzz`
// preset.
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tests/firmware/requests.h"

namespace {

constexpr std::uint32_t kMost_ms = 10 * kWeftMostOn_cs;

void demand(bool promise) {
  if (!promise) std::abort();
}

/// Runs the firmware and holds it to what it promises of light.
class Watched {
 public:
  void wait_ms(int ms) {
    for (int i = 0; i < ms; ++i) {
      board_.wait_ms(1);
      ++silent_ms_;
      check();
    }
  }
  void hear(std::uint8_t byte) {
    if (!board_.hear({byte}).empty()) silent_ms_ = 0;
    check();
  }

 private:
  void check() const {
    const auto lit = static_cast<unsigned>(board_.lit());
    demand(lit < 1U << kWeftBelow && std::popcount(lit) <= 2);
    demand(lit == 0 || silent_ms_ < kWeftDeadMan_ms);
    for (const auto heat_ms : board_.heat.ms) demand(heat_ms <= kMost_ms);
  }
  weft::test::BareBoard board_;
  int silent_ms_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Watched board;
  if (size > 0 && (data[0] & 1) != 0) {
    for (std::size_t at = 1; at + 6 < size; at += 7) {
      board.wait_ms(data[at] * 4);
      const std::size_t length = data[at + 1] % 5;
      const weft::test::Bytes payload(data + at + 3, data + at + 3 + std::min<std::size_t>(length, 4));
      for (const auto byte : weft::test::request(data[at + 1], data[at + 2] % 8, payload)) board.hear(byte);
    }
  } else {
    for (std::size_t at = 1; at < size; ++at) {
      if (data[at] == 0) board.wait_ms(25);
      board.hear(data[at]);
    }
  }
  return 0;
}
