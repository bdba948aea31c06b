// SPDX-License-Identifier: Apache-2.0
// Live view through weft-camera and the real libgphoto2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/capture/camera/link_bench.h"

namespace weft::capture {
namespace {

TEST(LiveView, ShowsPicturesUntilAShotIsTakenAndAfterIt) {
  LinkBench bench(with_finder());
  CameraLink& link = bench.ready();
  std::uint8_t last = 0;
  for (int shot = 0; shot < 2; ++shot) {
    for (int i = 0; i < 5; ++i) {
      const Result<std::string> picture = link.look();
      ASSERT_TRUE(picture) << picture.error().message();
      ASSERT_EQ(picture->size(), 40'000U);
      EXPECT_GT(static_cast<std::uint8_t>((*picture)[2]), last);
      last = static_cast<std::uint8_t>((*picture)[2]);
    }
    const Result<Photograph> taken = link.take(bench.raw(shot), [] {});
    ASSERT_TRUE(taken) << taken.error().message();
    EXPECT_NEAR(taken->exposure.exposure_us, 1e6 / 60, 1);
  }
  EXPECT_TRUE(link.look());
  EXPECT_TRUE(link.stop_looking());
  EXPECT_TRUE(link.stop_looking()) << "off already";
  EXPECT_EQ(bench.camera().shots(), 2);
}

TEST(LiveView, ThatHangsIsGivenUpInTimeAndComesBack) {
  for (const char* fault : {"live_stalls", "never_live"}) {
    LinkBench bench(with_finder());
    CameraLink& link = bench.link();
    ASSERT_TRUE(link.connect());
    ASSERT_TRUE(link.look());
    ASSERT_TRUE(bench.camera().inject({fault, 1}));
    const auto began = std::chrono::steady_clock::now();
    const Result<std::string> none = link.look();
    ASSERT_FALSE(none) << fault;
    EXPECT_EQ(none.error().kind, ErrorKind::kTryAgain) << fault << ": " << none.error().message();
    EXPECT_LT(seconds_since(began), 4) << fault;
    ASSERT_TRUE(bench.camera().inject({"well", 1}));
    const Result<CameraFacts> back = link.recover();
    ASSERT_TRUE(back) << fault << ": " << back.error().message();
    const Result<std::string> again = link.look();
    EXPECT_TRUE(again) << fault << ": " << again.error().message();
  }
}

}  // namespace
}  // namespace weft::capture
