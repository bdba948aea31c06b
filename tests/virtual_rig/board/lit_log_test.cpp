// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/board/lit_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::virtual_rig {
namespace {

using namespace std::chrono_literals;
using testing::DoubleNear;
using testing::ElementsAre;

const RigClock::time_point kStart = RigClock::time_point(100s);

TEST(LitLog, IsDarkBeforeAnythingHappens) {
  const LitLog log;
  EXPECT_EQ(log.now(), 0);
  EXPECT_THAT(log.lit_seconds(kStart, kStart + 1s, 3), ElementsAre(0, 0, 0));
}

TEST(LitLog, AddsUpWhatWasLitWithinTheTimesAskedFor) {
  LitLog log;
  log.record(kStart, 0b001);
  log.record(kStart + 1s, 0b110);
  log.record(kStart + 3s, 0b000);
  log.record(kStart + 4s, 0b010);
  EXPECT_EQ(log.now(), 0b010);
  EXPECT_THAT(log.lit_seconds(kStart - 1s, kStart + 5s, 3), ElementsAre(1, 3, 2));
  EXPECT_THAT(log.lit_seconds(kStart + 500ms, kStart + 1500ms, 3), ElementsAre(0.5, 0.5, 0.5));
  EXPECT_THAT(log.lit_seconds(kStart + 3s, kStart + 4s, 3), ElementsAre(0, 0, 0));
  EXPECT_THAT(log.lit_seconds(kStart + 6s, kStart + 8s, 2), ElementsAre(0, 2));
  EXPECT_THAT(log.lit_seconds(kStart - 9s, kStart - 8s, 2), ElementsAre(0, 0));
  EXPECT_THAT(log.lit_seconds(kStart + 2s, kStart + 2s, 2), ElementsAre(0, 0));
}

TEST(LitLog, TimesThatFallAreTakenForTheLast) {
  LitLog log;
  log.record(kStart, 1);
  log.record(kStart - 1s, 0);
  EXPECT_THAT(log.lit_seconds(kStart - 5s, kStart + 5s, 1), ElementsAre(0));
}

TEST(LitLog, KeepsTheLastThousandSeconds) {
  LitLog log;
  for (int i = 0; i < 5000; ++i) log.record(kStart + i * 1s, static_cast<std::uint16_t>(i % 2));
  const auto end = kStart + 5000s;
  EXPECT_THAT(log.lit_seconds(end - 1000s, end, 1), ElementsAre(DoubleNear(500, 1e-9)));
}

}  // namespace
}  // namespace weft::virtual_rig
