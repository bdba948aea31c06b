// SPDX-License-Identifier: Apache-2.0
// Every error that devices.h allows, at every shot of a scan.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/files.h"
#include "core/rig/session.h"
#include "tests/capture/scan/scan_bench.h"

namespace weft::capture {
namespace {

using test::ScanBench;
using test::SimulatedRig;
using testing::HasSubstr;
using Fault = SimulatedRig::Fault;

constexpr int kShots = 13;

/// The fault once, at each shot: the scan gets over it by itself.
void expect_passes(Fault fault, int retaken) {
  for (int take = 1; take <= kShots; ++take) {
    ScanBench bench;
    bench.rig.absent = 1;
    bench.rig.camera_faults[take] = fault;
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_TRUE(outcome) << "at take " << take << ": " << outcome.error().message();
    EXPECT_EQ(bench.objection(), "") << "at take " << take;
    EXPECT_EQ(outcome->frames_retaken, retaken) << "at take " << take;
    EXPECT_FALSE(bench.rig.is_lit());
  }
}

TEST(ScanFaults, ACameraThatDoesNotAnswerOnceCostsOneTake) {
  expect_passes(Fault::kNoAnswer, 1);
}
TEST(ScanFaults, APhotographThatNeverComesIsTakenAgain) {
  expect_passes(Fault::kLost, 1);
}
TEST(ScanFaults, NonsenseFromACameraCostsOneTake) {
  expect_passes(Fault::kNonsense, 1);
}
TEST(ScanFaults, ACableThatIsPulledAndPluggedAgainCostsOneTake) {
  expect_passes(Fault::kUnplugged, 1);
}
TEST(ScanFaults, ATruncatedPhotographIsTakenAgain) {
  expect_passes(Fault::kTruncated, 1);
}
TEST(ScanFaults, APhotographThatChangesOnTheDiskIsTakenAgain) {
  expect_passes(Fault::kDamaged, 1);
}
TEST(ScanFaults, APhotographThatComesOneShotLateIsNeverTakenForTheNextOne) {
  for (int take = 1; take < kShots; ++take) {
    ScanBench bench;
    bench.rig.camera_faults[take] = Fault::kLate;
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_TRUE(outcome) << "at take " << take << ": " << outcome.error().message();
    EXPECT_EQ(bench.objection(), "") << "at take " << take;
  }
}

TEST(ScanFaults, AFileThatComesTwiceIsTakenAgainWithoutAnyEvidenceByLight) {
  for (const bool is_calibrated : {true, false}) {
    for (int take = 2; take <= kShots; ++take) {
      ScanBench bench;
      bench.rig.camera_faults[take] = Fault::kTwice;
      if (!is_calibrated) bench.request.calibration.clear();
      const Result<ScanOutcome> outcome = bench.scan();
      ASSERT_TRUE(outcome) << "at take " << take << ": " << outcome.error().message();
      EXPECT_EQ(bench.objection(), "") << "at take " << take;
      EXPECT_EQ(outcome->frames_retaken, 1) << "at take " << take;
      ASSERT_EQ(bench.refused.size(), 1U) << "at take " << take;
      EXPECT_THAT(bench.refused[0].why, testing::AllOf(HasSubstr("one photograph twice"), HasSubstr("raw/")));
    }
  }
}

TEST(ScanFaults, ALedThatGoesOutInOneExposureIsPhotographedAgain) {
  for (int take = 2; take < kShots; ++take) {  // the first and the last are dark shots
    ScanBench bench;
    bench.rig.camera_faults[take] = Fault::kLedWentOut;
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_TRUE(outcome) << "at take " << take << ": " << outcome.error().message();
    EXPECT_EQ(bench.objection(), "") << "at take " << take;
    EXPECT_EQ(outcome->frames_retaken, 1);
  }
}

TEST(ScanFaults, AShutterThatSomebodyElseReleasesCostsOneTake) {
  for (int take = 2; take <= kShots; ++take) {
    ScanBench bench;
    bench.rig.camera_faults[take] = Fault::kSecondShutter;
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_TRUE(outcome) << "at take " << take << ": " << outcome.error().message();
    EXPECT_EQ(bench.objection(), "") << "at take " << take;
  }
}

TEST(ScanFaults, ABoardThatFailsAtAnyCommandCostsAtMostOneTake) {
  for (const ErrorKind kind : {ErrorKind::kTryAgain, ErrorKind::kProtocol, ErrorKind::kNoDevice}) {
    for (int call = 1; call <= 2 * kShots; ++call) {
      ScanBench bench;
      bench.rig.absent = 1;
      bench.rig.lamp_faults[call] = kind;
      const Result<ScanOutcome> outcome = bench.scan();
      ASSERT_TRUE(outcome) << "at command " << call << ": " << outcome.error().message();
      EXPECT_EQ(bench.objection(), "") << "at command " << call;
      EXPECT_LE(outcome->frames_retaken, 1) << "at command " << call;
    }
  }
}

/// The scan ends with `kind`, resumable, and the same call finishes it once `mend` was done.
void expect_resumable(ScanBench& bench, ErrorKind kind, const std::string& words,
                      const std::function<void()>& mend) {
  const Result<ScanOutcome> failed = bench.scan();
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, kind) << failed.error().message();
  EXPECT_THAT(failed.error().message(), HasSubstr(words));
  EXPECT_FALSE(bench.rig.is_lit());
  EXPECT_EQ(bench.statuses.back().phase, ScanPhase::kFailed);
  EXPECT_THAT(bench.statuses.back().why, HasSubstr(words));
  const Result<Session> left = read_session(bench.request.session);
  ASSERT_TRUE(left) << left.error().message();
  EXPECT_EQ(left->state, "capturing");
  mend();
  const Result<ScanOutcome> resumed = bench.scan();
  ASSERT_TRUE(resumed) << resumed.error().message();
  EXPECT_EQ(resumed->frames_resumed, static_cast<int>(left->shots.size()));
  EXPECT_EQ(bench.objection(), "");
}

TEST(ScanFaults, ABatteryOrADiskThatGivesOutEndsTheScanUntilItIsMended) {
  for (int take = 1; take <= kShots; ++take) {
    ScanBench battery;
    battery.rig.camera_faults[take] = Fault::kBattery;
    expect_resumable(battery, ErrorKind::kBadData, "battery is empty", [] {});
    ScanBench disk;
    disk.rig.camera_faults[take] = Fault::kFullDisk;
    expect_resumable(disk, ErrorKind::kInputOutput, "disk is full", [] {});
  }
}

TEST(ScanFaults, ADeviceThatStaysAwayEndsTheScanWhenPatienceEnds) {
  ScanBench bench;
  bench.options.device_patience_s = 0.2;
  bench.rig.absent = 1000;
  bench.rig.camera_faults[6] = Fault::kUnplugged;
  const auto start = std::chrono::steady_clock::now();
  const Result<ScanOutcome> failed = bench.scan();
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, ErrorKind::kNoDevice);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  EXPECT_EQ(bench.kept.size(), 5u);
}

TEST(ScanFaults, AShotThatFailsThreeTimesEndsTheScan) {
  ScanBench bench;
  for (const int take : {4, 5, 6}) bench.rig.camera_faults[take] = Fault::kNoAnswer;
  expect_resumable(bench, ErrorKind::kTryAgain, "does not answer", [] {});
}

TEST(ScanFaults, AFileThatComesTwiceAgainEndsTheScanAndTheNextGoesOn) {
  ScanBench bench;
  bench.rig.camera_faults[5] = Fault::kTwice;
  bench.rig.on_take = [&](int take) {
    if (take > 5) bench.rig.camera_faults[take] = Fault::kTwice;
  };
  expect_resumable(bench, ErrorKind::kProtocol, "raw/03_led03.dng, byte for byte", [&] {
    bench.rig.on_take = [](int) {};
    bench.rig.camera_faults.clear();
  });
}

TEST(ScanFaults, ADeadLedEndsTheScanByItsName) {
  for (const int led : {1, 2, 5, 10}) {
    ScanBench bench;
    bench.rig.gain[led] = 0;
    expect_resumable(bench, ErrorKind::kBadData, "LED " + std::to_string(led) + " is dark",
                     [&] { bench.rig.gain.clear(); });
  }
}

TEST(ScanFaults, SwappedWiresEndTheScanByTheirNamesAndBothLedsAreTakenAgain) {
  ScanBench bench;
  bench.rig.wires = {{3, 4}, {4, 3}};
  expect_resumable(bench, ErrorKind::kBadData, "LED 4 lights where LED 3 should and the other way round",
                   [&] { bench.rig.wires.clear(); });
}

TEST(ScanFaults, ALedThatStaysLitEndsTheScanByItsName) {
  ScanBench bench;
  bench.rig.stays_lit = 2;
  bench.rig.stays_lit_from = 4;
  expect_resumable(bench, ErrorKind::kBadData, "LED 2 stays lit", [&] { bench.rig.stays_lit = 0; });
}

TEST(ScanFaults, ALampInTheRoomEndsTheScanAtItsFirstShots) {
  ScanBench bench;
  bench.rig.room = 0.2;
  const Result<ScanOutcome> failed = bench.scan();
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().message(), HasSubstr("lamp on in the room"));
  EXPECT_LE(bench.rig.takes(), 2);
}

TEST(ScanFaults, ALampThatComesOnMeanwhileAndIsPutOutLeavesNoFrameOfItsLight) {
  for (const double room : {0.2, 0.35, 0.6, 1.0}) {
    for (const int take : {3, 5, 8}) {
      ScanBench bench;
      bench.rig.room = room;
      bench.rig.room_from = take;
      const Result<ScanOutcome> failed = bench.scan();
      ASSERT_FALSE(failed) << room << " from take " << take;
      bench.rig.room = 0;
      const Result<ScanOutcome> resumed = bench.scan();
      ASSERT_TRUE(resumed) << resumed.error().message();
      EXPECT_EQ(bench.objection(), "") << room << " from take " << take;
    }
  }
}

TEST(ScanFaults, LightThatPassesAtTheRepeatHasAllFramesTakenAgainInTheirOrder) {
  constexpr int kRepeatTake = 12;  // after the dark shot and ten LEDs
  ScanBench bench;
  bench.rig.on_take = [&](int take) { bench.rig.room = take == kRepeatTake ? 0.3 : 0; };
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  // The dark shot at the end was on its way already, and is taken again too.
  EXPECT_EQ(bench.rig.takes(), kRepeatTake + 1 + 12);
  int last = 0;
  for (const Shot& shot : outcome->session.shots) {
    if (shot.led == 0) continue;
    const int number = shot.document.at("image_number").get<int>();
    EXPECT_GT(number, last) << shot.file << ": the repeat is held against its first frame";
    last = number;
  }
}

TEST(ScanFaults, EachRefusedFrameIsToldWithTheCodeOfItsFinding) {
  using Told = std::vector<std::pair<int, std::string>>;  // index and code
  const auto told = [](const std::function<void(ScanBench&)>& damage) {
    ScanBench bench;
    damage(bench);
    static_cast<void>(bench.scan().has_value());
    Told all;
    for (const RefusedFrame& frame : bench.refused) {
      EXPECT_NE(frame.why, "");
      EXPECT_EQ(frame.led, frame.index) << "the dark shot and a LED each";
      all.emplace_back(frame.index, frame.finding.code);
    }
    return all;
  };
  EXPECT_EQ(told([](ScanBench& b) { b.rig.camera_faults[4] = Fault::kLedWentOut; }), (Told{{3, "dark"}}));
  EXPECT_EQ(told([](ScanBench& b) { b.rig.gain[5] = 0; }), (Told{{5, "dark"}, {5, "dark"}}));
  EXPECT_EQ(told([](ScanBench& b) { b.rig.room = 0.2; }), (Told{{0, "room_light"}}));
  EXPECT_EQ(told([](ScanBench& b) { b.rig.camera_faults[4] = Fault::kTruncated; }), (Told{{3, "damaged"}}));
  EXPECT_THAT(told([](ScanBench& b) {
                b.rig.wires = {{3, 4}, {4, 3}};
              }),
              testing::UnorderedElementsAre(std::pair(3, "swapped"), std::pair(4, "swapped")));
  EXPECT_EQ(told([](ScanBench&) {}), Told{});
}

TEST(ScanFaults, TakesNoMoreThanOneFurtherShotAfterAWrongOne) {
  ScanBench bench;
  bench.rig.wires = {{7, 8}};
  ASSERT_FALSE(bench.scan());
  EXPECT_LE(bench.rig.takes(), 9);
}

}  // namespace
}  // namespace weft::capture
