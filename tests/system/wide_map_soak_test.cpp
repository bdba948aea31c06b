// SPDX-License-Identifier: Apache-2.0
// The largest maps in a viewer, as far as the daemon answers for them: `weft bench page` measures the browser
// too.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "bench/server/served_rig.h"
#include "bench/server/wide_solve.h"
#include "core/base/statistics.h"
#include "tests/core/places.h"

namespace weft::bench {
namespace {

constexpr int kConnections = 6;  // as browsers have

/// The tiles of 512 pixels that a window of 1280 x 720 can touch.
std::vector<std::string> window_at(int column, int row) {
  std::vector<std::string> calls;
  for (const char* layer : kWideLayers) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 4; ++x) calls.push_back(wide_tile(layer, 0, column + x, row + y));
    }
  }
  return calls;
}

double seconds_of(const ServedRig& served, const std::vector<std::string>& calls) {
  const auto begin = std::chrono::steady_clock::now();
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> connections;
  for (int i = 0; i < kConnections; ++i) {
    connections.emplace_back([&] {
      for (std::size_t k = next++; k < calls.size(); k = next++) {
        const Result<std::string> tile = served.client().bytes(calls[k]);
        EXPECT_TRUE(tile) << tile.error().message();
      }
    });
  }
  connections.clear();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(WideMapSoak, TilesOfAWindowAnywhereInAHundredMegapixelsComeIn300Milliseconds) {
  ServedRig served;
  ASSERT_TRUE(served.start(program_folder(), in_sources("testdata/scenes/satin.toml"), 0.02));
  ASSERT_TRUE(served.serve());
  const Result<Json> next = served.client().get("/api/v1/next-name?fabric=wide");
  ASSERT_TRUE(next) << next.error().message();
  const std::filesystem::path session = next->at("folder").get<std::string>();
  ASSERT_TRUE(write_wide_solve(session.parent_path(), wide_size(100)));
  ASSERT_TRUE(served.client().bytes(wide_tile("normal", 0, 0, 0)));
  std::vector<double> seconds;
  for (const int row : {3, 8, 13}) {
    for (const int column : {2, 9, 17}) seconds.push_back(seconds_of(served, window_at(column, row)));
  }
  EXPECT_LE(lower_quantile(seconds, 0.5), 0.3)
      << "s in the median, " << std::ranges::max(seconds) << " s at most";
}

}  // namespace
}  // namespace weft::bench
