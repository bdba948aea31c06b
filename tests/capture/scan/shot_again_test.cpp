// SPDX-License-Identifier: Apache-2.0
// A shot of a finished session is taken once more.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capture/scan/scan_plan.h"
#include "capture/scan/second_copy.h"
#include "core/base/files.h"
#include "tests/capture/scan/scan_bench.h"

namespace weft::capture {
namespace {

using test::ScanBench;
using test::SimulatedRig;
using testing::HasSubstr;

struct ScannedBench : ScanBench {
  ScannedBench() {
    EXPECT_TRUE(scan());
    request.exposure.exposure_us = 0;
  }
  Result<ScanOutcome> again(int index) {
    request.again = index;
    return scan();
  }
  Session session() const { return *read_session(request.session); }
};

TEST(ShotAgain, StandsForTheOldOneWhichStays) {
  ScannedBench bench;
  const Session before = bench.session();
  const Result<ScanOutcome> outcome = bench.again(3);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(bench.objection(), "");
  const Session after = bench.session();
  ASSERT_EQ(after.shots.size(), before.shots.size() + 1);
  EXPECT_EQ(after.shots.back().file, "raw/13_led03.dng");
  EXPECT_EQ(after.shots[3].superseded_by, 13);
  EXPECT_EQ(after.shots[3].sha256, before.shots[3].sha256);
  EXPECT_EQ(after.shots.back().exposure_us, before.shots[3].exposure_us);
  EXPECT_EQ(after.lit()[2]->index, 13);
  ASSERT_EQ(bench.kept.size(), 1U) << "nothing else was taken";
  EXPECT_EQ(bench.statuses.back().frames, 14);
  EXPECT_EQ(bench.statuses.back().frames_planned, 14);
}

TEST(ShotAgain, MayBeTakenAgainAndSoMayTheDarkOne) {
  ScannedBench bench;
  ASSERT_TRUE(bench.again(3));
  const Result<ScanOutcome> twice = bench.again(13);
  ASSERT_TRUE(twice) << twice.error().message();
  const Result<ScanOutcome> dark = bench.again(0);
  ASSERT_TRUE(dark) << dark.error().message();
  EXPECT_EQ(bench.objection(), "");
  EXPECT_EQ(bench.session().dark()->file, "raw/15_led00.dng");
  EXPECT_EQ(bench.session().lit()[2]->index, 14);
}

TEST(ShotAgain, IsRefusedWhereItIsNoneOfThese) {
  ScannedBench bench;
  ASSERT_TRUE(bench.again(3));
  EXPECT_THAT(bench.again(3).error().message(), HasSubstr("shot 13 stands for it already"));
  EXPECT_THAT(bench.again(11).error().message(), HasSubstr("it is a repeat shot"));
  EXPECT_THAT(bench.again(40).error().message(), HasSubstr("there is no such shot"));
  EXPECT_EQ(bench.session().shots.size(), 14U);
  EXPECT_EQ(bench.objection(), "");
}

TEST(ShotAgain, TakesAnotherExposureOnlyByARatioThatWasMeasured) {
  ScannedBench bench;
  bench.request.exposure.exposure_us = bench.session().shots[3].exposure_us / 4;
  bench.request.exposure.exposure_us =
      nearest_time_us(*bench.rig.camera().shutter_times_us(), bench.request.exposure.exposure_us);
  const Result<ScanOutcome> outcome = bench.again(3);
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().message(), HasSubstr("nobody measured the ratio"));
  EXPECT_THAT(outcome.error().message(), HasSubstr("scan the cloth again at another exposure"));
  EXPECT_EQ(bench.objection(), "");
}

TEST(ShotAgain, OfAnotherLightLeavesTheSessionAsItWas) {
  ScannedBench bench;
  const std::string before = *read_text(bench.request.session / "session.json");
  bench.rig.wires = {{3, 7}, {7, 3}};
  const Result<ScanOutcome> outcome = bench.again(3);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, ErrorKind::kBadData) << outcome.error().message();
  EXPECT_EQ(*read_text(bench.request.session / "session.json"), before);
  EXPECT_EQ(bench.objection(), "");
}

TEST(ShotAgain, ThatFailsOnItsWayLeavesTheSessionAsItWas) {
  for (const auto fault : {SimulatedRig::Fault::kBattery, SimulatedRig::Fault::kFullDisk}) {
    ScannedBench bench;
    const std::string before = *read_text(bench.request.session / "session.json");
    bench.rig.camera_faults[bench.rig.takes() + 1] = fault;
    ASSERT_FALSE(bench.again(3));
    EXPECT_EQ(*read_text(bench.request.session / "session.json"), before);
    EXPECT_EQ(bench.objection(), "");
  }
}

TEST(ShotAgain, ReachesTheSecondCopy) {
  ScanBench bench;
  bench.request.copy = bench.folder / "copies";
  ASSERT_TRUE(bench.scan());
  bench.request.exposure.exposure_us = 0;
  bench.request.again = 5;
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  const Result<Session> copy = read_session(place_of_copy(outcome->session, bench.request.copy));
  ASSERT_TRUE(copy) << copy.error().message();
  EXPECT_EQ(copy->shots.size(), 14U);
  EXPECT_EQ(*sha256_of_file(copy->path_of(copy->shots.back())), copy->shots.back().sha256);
  EXPECT_EQ(read_session(bench.request.session)->document["copy"]["state"], "verified");
}

}  // namespace
}  // namespace weft::capture
