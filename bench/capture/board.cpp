// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/board.h"

#include <chrono>
#include <utility>
#include <vector>

#include "capture/board/led_board.h"
#include "core/statistics.h"

namespace weft::bench {

Result<Rows> capture_board_table(const CaptureBoardOptions& options) {
  auto board = capture::LedBoard::open({options.port});
  if (!board) return std::move(board).error();
  const auto before = (*board)->status();
  if (!before) return before.error();

  std::vector<double> times_ms;
  for (int i = 0; i < options.commands; ++i) {
    const int led = 1 + i % (*board)->leds();
    const auto begin = std::chrono::steady_clock::now();
    const auto lit = (*board)->light({&led, 1}, 1);
    const std::chrono::duration<double, std::milli> time_ms = std::chrono::steady_clock::now() - begin;
    if (lit && *lit == 0) times_ms.push_back(time_ms.count());
  }
  static_cast<void>((*board)->light({}, 0));
  const auto after = (*board)->status();
  if (!after) return after.error();

  const Json row = {{"commands", options.commands},
                    {"lost", options.commands - static_cast<int>(times_ms.size())},
                    {"median_ms", lower_quantile(times_ms, 0.5)},
                    {"p99_ms", lower_quantile(times_ms, 0.99)},
                    {"most_ms", lower_quantile(times_ms, 1)},
                    {"bad_frames", after->bad_frames - before->bad_frames},
                    {"overruns", after->overruns - before->overruns}};
  return Rows{row};
}

}  // namespace weft::bench
