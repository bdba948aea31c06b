// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/scan_pace.h"

#include <gtest/gtest.h>

namespace weft::app {
namespace {

using capture::ScanPhase;

/// A scan of 13 frames by a clock of its own.
struct Told {
  void tell(ScanPhase phase, int frames, double after_s) {
    now += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(after_s));
    capture::ScanStatus status;
    status.phase = phase;
    status.frames = frames;
    status.frames_planned = 13;
    pace.follow(status, now);
  }

  ScanPace pace;
  ScanPace::Time now;
};

TEST(ScanPace, IsTimeAFrameFromTheSecondOn) {
  Told scan;
  scan.tell(ScanPhase::kConnecting, 0, 0);
  scan.tell(ScanPhase::kMetering, 0, 9);
  scan.tell(ScanPhase::kExposing, 0, 3);
  scan.tell(ScanPhase::kExposing, 1, 5);
  EXPECT_FALSE(scan.pace.left_s());
  scan.tell(ScanPhase::kExposing, 2, 2);
  EXPECT_NEAR(scan.pace.left_s().value_or(0), 11 * 3.5, 1e-6);
  scan.tell(ScanPhase::kFetching, 3, 1);
  EXPECT_NEAR(scan.pace.shot_s().value_or(0), 8.0 / 3, 1e-6);
  EXPECT_NEAR(scan.pace.left_s().value_or(0), 10 * 8.0 / 3, 1e-6);
}

TEST(ScanPace, DoesNotCountTheFramesOfARunBefore) {
  Told scan;
  scan.tell(ScanPhase::kConnecting, 0, 0);
  scan.tell(ScanPhase::kConnecting, 6, 1);
  scan.tell(ScanPhase::kExposing, 6, 1);
  scan.tell(ScanPhase::kExposing, 7, 2);
  EXPECT_FALSE(scan.pace.left_s());
  scan.tell(ScanPhase::kExposing, 8, 2);
  EXPECT_NEAR(scan.pace.left_s().value_or(0), 10, 1e-6);
}

TEST(ScanPace, StandsStillWhileADeviceOrAPersonIsWaitedFor) {
  for (const ScanPhase waits : {ScanPhase::kRecovering, ScanPhase::kPaused}) {
    Told scan;
    scan.tell(ScanPhase::kExposing, 0, 1);
    scan.tell(ScanPhase::kExposing, 1, 2);
    scan.tell(ScanPhase::kExposing, 2, 2);
    const double before_s = scan.pace.left_s().value_or(0);
    EXPECT_NEAR(before_s, 22, 1e-6);
    scan.tell(waits, 2, 0);
    for (int second = 0; second < 30; ++second) {
      scan.tell(waits, 2, 1);
      EXPECT_EQ(scan.pace.left_s().value_or(0), before_s) << "after " << second + 1 << " s";
    }
    scan.tell(ScanPhase::kExposing, 2, 0);
    scan.tell(ScanPhase::kExposing, 3, 2);
    EXPECT_NEAR(scan.pace.shot_s().value_or(0), 2, 1e-6);
    EXPECT_NEAR(scan.pace.left_s().value_or(0), 20, 1e-6);
  }
}

TEST(ScanPace, LeavesMoreSecondsOnlyWhereMoreIsToBeDone) {
  Told scan;
  scan.tell(ScanPhase::kExposing, 0, 1);
  scan.tell(ScanPhase::kExposing, 1, 1);
  scan.tell(ScanPhase::kExposing, 2, 1);
  scan.tell(ScanPhase::kExposing, 3, 18);  // a LED had to cool
  EXPECT_NEAR(scan.pace.left_s().value_or(0), 11, 1e-6);
  scan.tell(ScanPhase::kExposing, 1, 1);  // two are taken again
  EXPECT_NEAR(scan.pace.left_s().value_or(0), 12 * 20.0 / 3, 1e-6);
}

}  // namespace
}  // namespace weft::app
