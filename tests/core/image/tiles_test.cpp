// SPDX-License-Identifier: Apache-2.0
#include "core/image/tiles.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <limits>
#include <ostream>

#include "tests/core/child.h"

namespace weft {

static std::ostream& operator<<(std::ostream& out, Rect r) {
  return out << "columns " << r.x0 << " to " << r.x1 << ", rows " << r.y0 << " to " << r.y1;
}

namespace {

const std::array<Rect, 5> kAreas = {
    {{0, 0, 1, 1}, {0, 0, 64, 64}, {0, 0, 601, 77}, {128, 5, 333, 40}, {64, 3, 129, 4}}};
const std::array<TileOptions, 6> kOptions = {
    {{}, {1, 1, 1}, {64, 8, 2}, {100, 7, 3}, {0, -3, 2}, {100'000, 100'000, 2}}};

TEST(Tiles, CoverAnAreaExactlyOnce) {
  for (const Rect area : kAreas) {
    for (const TileOptions& options : kOptions) {
      Image<int> seen({area.x1 + 70, area.y1 + 5});
      for (const Rect tile : tiles_of(area, options)) {
        for (int y = tile.y0; y < tile.y1; ++y) {
          for (int x = tile.x0; x < tile.x1; ++x) ++seen(x, y);
        }
      }
      for (int y = 0; y < seen.height(); ++y) {
        for (int x = 0; x < seen.width(); ++x) {
          const int inside = x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1;
          ASSERT_EQ(seen(x, y), inside) << "pixel (" << x << ", " << y << ") of " << area << ", tiles of "
                                        << options.width << " x " << options.height;
        }
      }
    }
  }
}

TEST(Tiles, EndOnARowGroupUnlessTheAreaDoesNot) {
  for (const Rect area : kAreas) {
    for (const TileOptions& options : kOptions) {
      for (const Rect tile : tiles_of(area, options)) {
        EXPECT_EQ(tile.x0 % kRowGroup, 0) << tile;
        EXPECT_TRUE(tile.width() % kRowGroup == 0 || tile.x1 == area.x1) << tile << " of " << area;
        EXPECT_GT(tile.pixels(), 0) << tile;
      }
    }
  }
}

TEST(Tiles, OfAnEmptyAreaAreNone) {
  EXPECT_TRUE(tiles_of({64, 3, 64, 9}, {}).empty());
  EXPECT_TRUE(tiles_of({}, {}).empty());
}

TEST(Tiles, OfTheLargestSizeThereIsAreTheArea) {
  constexpr int kMost = std::numeric_limits<int>::max();
  for (const TileOptions& options : {TileOptions{kMost, 100, 1}, TileOptions{1024, kMost, 1}}) {
    const std::string said = said_by_child([&] {
      const rlimit a_second = {1, 1};
      setrlimit(RLIMIT_CPU, &a_second);
      return std::to_string(tiles_of({64, 3, 601, 77}, options).size());
    });
    EXPECT_EQ(said, "1") << options.width << " x " << options.height;
  }
}

TEST(ForEachTile, RunsTheTilesOfTheAreaWithWorkersBelowTheThreads) {
  for (const int threads : {1, 2, 7}) {
    const TileOptions options = {64, 8, threads};
    const Rect area = {64, 3, 601, 77};
    Image<int> seen({area.x1, area.y1});
    const Result<void> done = for_each_tile(area, options, {}, [&](Rect tile, int worker) {
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) seen(x, y) += worker >= 0 && worker < threads ? 1 : 100;
      }
    });
    ASSERT_TRUE(done) << done.error().message();
    int sum = 0;
    for (int y = area.y0; y < area.y1; ++y) {
      for (int x = area.x0; x < area.x1; ++x) sum += seen(x, y);
    }
    EXPECT_EQ(sum, area.pixels()) << threads << " threads";
  }
}

TEST(ForEachTile, StartsNothingOnceStopIsRequested) {
  std::stop_source stop;
  int begun = 0;
  const Result<void> stopped = for_each_tile({0, 0, 640, 640}, {64, 64, 1}, stop.get_token(), [&](Rect, int) {
    if (++begun == 5) stop.request_stop();
  });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(begun, 5);
  EXPECT_FALSE(for_each_tile({0, 0, 640, 640}, {64, 64, 2}, stop.get_token(), [&](Rect, int) { ++begun; }));
  EXPECT_EQ(begun, 5) << "tiles begun after the stop";
}

}  // namespace
}  // namespace weft
