// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <set>
#include <stop_token>

#include "capture/scan/scan_plan.h"
#include "capture/scan/second_copy.h"
#include "core/base/files.h"
#include "tests/capture/scan/scan_bench.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using test::ScanBench;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Scan, MakesASessionOfAllLedsThatIsComplete) {
  ScanBench bench;
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->warnings, IsEmpty());
  EXPECT_EQ(outcome->frames_resumed, 0);
  EXPECT_EQ(outcome->frames_retaken, 0);
  EXPECT_EQ(bench.objection(), "");
  const Result<Session> session = read_session(bench.request.session);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->lit().size(), 10u);
  ASSERT_NE(session->dark(), nullptr);
  EXPECT_EQ(session->shots.size(), 13u);
  EXPECT_FALSE(bench.rig.is_lit());
  const Result<Calibration> calibration = read_calibration(session->calibration_folder());
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->id, session->calibration_id);
}

TEST(Scan, MetersTheClothAndRecordsHow) {
  ScanBench bench;
  bench.request.exposure.exposure_us = 0;
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  const Json& exposure = outcome->session.document["exposure"];
  EXPECT_EQ(exposure["from"], "meter");
  EXPECT_EQ(exposure["meter"]["test_shots"].size(), 2u);
  EXPECT_EQ(outcome->session.shots[1].exposure_us, exposure["exposure_us"]);
  const double bright = bench.kept[1].histogram_rgb[1].clipped;
  EXPECT_EQ(bright, 0);
  EXPECT_EQ(bench.rig.takes(), 15) << "two test shots and the frames";
}

TEST(Scan, ExposesForTheCamerasNearestTimeAndSaysSo) {
  ScanBench bench;
  const double own_us = bench.request.exposure.exposure_us;
  bench.request.exposure.exposure_us = 1.08 * own_us;
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->session.shots[1].exposure_us, own_us);
  ASSERT_EQ(outcome->warnings.size(), 1u);
  EXPECT_THAT(outcome->warnings.front(), HasSubstr("that the camera has nearest to"));
  EXPECT_EQ(bench.objection(), "");
}

TEST(Scan, MakesNoSessionForAnExposureThatTheCameraDoesNotHave) {
  for (const double exposure_us : {16.2, 1e9}) {
    ScanBench bench;
    bench.request.exposure.exposure_us = exposure_us;
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_FALSE(outcome) << exposure_us << " us";
    EXPECT_EQ(outcome.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(outcome.error().why, HasSubstr("it has 244 us to 32 s"));
    EXPECT_FALSE(fs::exists(bench.request.session));
    EXPECT_EQ(bench.rig.takes(), 0);
  }
}

TEST(Scan, TellsOfEveryFrameWithItsHistogram) {
  ScanBench bench;
  ASSERT_TRUE(bench.scan());
  ASSERT_EQ(bench.kept.size(), 13u);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(bench.kept[i].shot.index, static_cast<int>(i));
    std::uint64_t sites = 0;
    for (const RawHistogram& histogram : bench.kept[i].histogram_rgb) {
      for (const std::uint32_t n : histogram.bins) sites += n;
    }
    EXPECT_EQ(sites, 96u * 64u);
  }
  EXPECT_EQ(bench.statuses.back().phase, ScanPhase::kComplete);
  EXPECT_EQ(bench.statuses.back().frames, 13);
  EXPECT_EQ(bench.statuses.back().frames_planned, 13);
}

TEST(Scan, TakesBracketsAndSaysThatTheirRatioIsNotMeasured) {
  ScanBench bench;
  bench.request.bracket = 4;
  bench.request.leds = {1, 2, 3, 4, 5};
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->session.shots.size(), 13u);
  EXPECT_NEAR(outcome->session.shots[8].exposure_us, 4 * outcome->session.shots[1].exposure_us, 5);
  ASSERT_EQ(outcome->warnings.size(), 1u);
  EXPECT_THAT(outcome->warnings.front(), HasSubstr("no measured ratio"));
}

TEST(Scan, RefusesAFinishedSessionBeforeItTouchesADevice) {
  ScanBench bench;
  ASSERT_TRUE(bench.scan());
  const int takes = bench.rig.takes();
  const Result<ScanOutcome> again = bench.scan();
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kCannotCreate);
  EXPECT_EQ(bench.rig.takes(), takes);
}

TEST(Scan, RefusesWhatTheCalibrationIsNotOfBeforeTheFirstShot) {
  const auto refusal = [](const std::function<void(ScanBench&)>& change) {
    ScanBench bench;
    change(bench);
    const Result<ScanOutcome> outcome = bench.scan();
    EXPECT_FALSE(outcome);
    EXPECT_EQ(bench.rig.takes(), 0);
    EXPECT_FALSE(is_there(bench.request.session)) << "nothing was begun";
    if (outcome) return std::string();
    EXPECT_EQ(outcome.error().kind, ErrorKind::kBadData);
    return outcome.error().why;
  };
  EXPECT_THAT(refusal([](ScanBench& b) { b.request.rig = "another rig"; }), HasSubstr("another rig"));
  EXPECT_THAT(refusal([](ScanBench& b) { b.request.exposure.f_number = 11; }), HasSubstr("f/11"));
  EXPECT_THAT(refusal([](ScanBench& b) { b.request.exposure.iso = 400; }), HasSubstr("ISO 400"));
  EXPECT_THAT(refusal([](ScanBench& b) { b.rig.facts.serial = "4242"; }), HasSubstr("4242"));
  EXPECT_THAT(refusal([](ScanBench& b) { b.rig.facts.model = "Canon EOS 5D"; }), HasSubstr("EOS 5D"));
}

/// Gives the request a changed copy of its calibration.
void change_calibration(ScanBench& bench, const std::function<void(Calibration&)>& change) {
  Result<Calibration> calibration = read_calibration(bench.request.calibration);
  ASSERT_TRUE(calibration) << calibration.error().message();
  change(*calibration);
  const fs::path other = bench.folder / "other calibration";
  const Result<Calibration> written = write_calibration(other, std::move(*calibration));
  ASSERT_TRUE(written) << written.error().message();
  bench.request.calibration = other;
}

TEST(Scan, RefusesACalibrationOfAnotherPictureSizeAtTheFirstFrame) {
  ScanBench bench;
  change_calibration(bench, [](Calibration& c) {
    c.camera->size = {c.camera->size.width / 2, c.camera->size.height / 2};
  });
  for (const char* when : {"at first", "when it is run again"}) {
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error().what, "calibration is not of this camera") << when;
    EXPECT_THAT(outcome.error().why, HasSubstr("48 x 32 pixels, the frame 96 x 64")) << when;
    EXPECT_THAT(bench.kept, IsEmpty());
  }
  EXPECT_EQ(bench.rig.takes(), 4) << "two a scan: the second is on its way while the first is looked at";
}

TEST(Scan, RefusesALensThatIsNotSetAsItWasCalibrated) {
  const auto refusal = [](const std::function<void(Calibration&)>& change) {
    ScanBench bench;
    change_calibration(bench, [&](Calibration& calibration) {
      change(calibration);
      bench.request.exposure.f_number = calibration.subject.f_number;
    });
    const Result<ScanOutcome> outcome = bench.scan();
    EXPECT_THAT(bench.kept, IsEmpty());
    return outcome ? "scanned" : outcome.error().what + ": " + outcome.error().why;
  };
  EXPECT_THAT(refusal([](Calibration& c) { c.subject.focal_length_mm = 35; }),
              HasSubstr("calibration does not suit the frame: focal length 50 mm, not 35"));
  EXPECT_THAT(refusal([](Calibration& c) { c.subject.f_number = 11; }),
              HasSubstr("calibration does not suit the frame: the calibration holds at f/11, the frame was "
                        "taken at f/8"));
}

TEST(Scan, RefusesLedsThatAreNotThere) {
  ScanBench bench;
  bench.request.leds = {1, 2, 11};
  EXPECT_EQ(bench.scan().error().kind, ErrorKind::kUsage);
  bench.request.leds = {1, 2, 2};
  EXPECT_EQ(bench.scan().error().kind, ErrorKind::kUsage);
}

TEST(Scan, MakesASecondCopyAndOnlyWarnsWhereItCannot) {
  ScanBench bench;
  bench.request.copy = bench.folder / "other disk";
  ASSERT_TRUE(bench.scan());
  const Result<Session> first = read_session(bench.request.session);
  ASSERT_TRUE(first) << first.error().message();
  EXPECT_TRUE(is_there(place_of_copy(*first, bench.request.copy) / "session.json"));
  EXPECT_EQ(first->document["copy"]["state"], "verified");

  bench.request.session = bench.folder / "next.weft";
  fs::create_directories(place_of_copy(*first, bench.request.copy).parent_path() / "next.weft");
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  ASSERT_EQ(outcome->warnings.size(), 2u);
  EXPECT_THAT(outcome->warnings[0], HasSubstr("on the disk of the sessions"));
  EXPECT_THAT(outcome->warnings[1], HasSubstr("there is no second copy"));
  EXPECT_THAT(outcome->warnings[1], HasSubstr("weft copy " + bench.request.session.string()));
  EXPECT_EQ(outcome->session.document["copy"]["state"], "missing");
  EXPECT_EQ(bench.objection(), "");
}

TEST(Scan, IsStoppedAfterTheShotOnItsWayAndGoesOnWhereItWas) {
  ScanBench bench;
  std::stop_source stop;
  bench.control.cancel = stop.get_token();
  bench.rig.on_take = [&](int take) {
    if (take == 5) stop.request_stop();
  };
  const Result<ScanOutcome> stopped = bench.scan();
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted);
  EXPECT_EQ(bench.kept.size(), 5u);
  EXPECT_FALSE(bench.rig.is_lit());
  EXPECT_EQ(bench.statuses.back().phase, ScanPhase::kCancelled);

  bench.control.cancel = {};
  const Result<ScanOutcome> resumed = bench.scan();
  ASSERT_TRUE(resumed) << resumed.error().message();
  EXPECT_EQ(resumed->frames_resumed, 5);
  EXPECT_EQ(bench.rig.takes(), 13);
  EXPECT_EQ(bench.objection(), "");
}

TEST(Scan, ResumesAMeteredSessionWithItsExposure) {
  ScanBench bench;
  bench.request.exposure.exposure_us = 0;
  std::stop_source stop;
  bench.control.cancel = stop.get_token();
  bench.rig.on_take = [&](int take) {
    if (take == 6) stop.request_stop();
  };
  ASSERT_FALSE(bench.scan());
  bench.control.cancel = {};
  ASSERT_TRUE(bench.scan());
  EXPECT_EQ(bench.rig.takes(), 15) << "no test shot is taken twice";
  EXPECT_EQ(bench.objection(), "");
}

TEST(Scan, MetersAgainWhereNoFrameWasKept) {
  double undisturbed_us = 0;
  {
    ScanBench bench;
    bench.request.exposure.exposure_us = 0;
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_TRUE(outcome) << outcome.error().message();
    undisturbed_us = outcome->session.shots.front().exposure_us;
  }
  ScanBench bench;
  bench.request.exposure.exposure_us = 0;
  bench.rig.room = 1;
  ASSERT_FALSE(bench.scan()) << "a lamp lit the meter's shots and the dark one";
  bench.rig.room = 0;
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->session.shots.front().exposure_us, undisturbed_us);
}

TEST(Scan, IsPausedWithAllLedsOffBetweenTwoShots) {
  ScanBench bench;
  std::atomic<bool> pause = false;
  bench.control.pause = &pause;
  bench.rig.on_take = [&](int take) {
    if (take == 3) pause = true;
  };
  int takes_while_paused = 0;
  bool was_lit = true;
  bench.on_status = [&](const ScanStatus& status) {
    if (status.phase != ScanPhase::kPaused) return;
    takes_while_paused = bench.rig.takes();
    was_lit = bench.rig.is_lit();
    pause = false;
  };
  ASSERT_TRUE(bench.scan());
  EXPECT_EQ(takes_while_paused, 3);
  EXPECT_FALSE(was_lit);
  EXPECT_EQ(bench.objection(), "");
}

constexpr int kCallForLed1 = 4;  // of light(): off, nothing for the dark shot, off, LED 1

TEST(Scan, TellsOfTheRestOfALedAndDoesNotTakeItForALightThatWentOut) {
  ScanBench bench;
  bench.options.lamp_margin_s = 0.3;
  bench.rig.rests_s[kCallForLed1] = 0.6 + 1e-6 * bench.request.exposure.exposure_us;  // longer than it is lit
  std::set<std::string> rests;
  bool was_lit = false;
  bench.on_status = [&](const ScanStatus& status) {
    if (status.phase != ScanPhase::kCooling) return;
    rests.insert(status.why);
    was_lit = was_lit || bench.rig.is_lit();
  };
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->frames_retaken, 0);
  EXPECT_THAT(rests, testing::ElementsAre("LED 1 cools, 1 s"));
  EXPECT_FALSE(was_lit);
  EXPECT_EQ(bench.objection(), "");
}

TEST(Scan, IsStoppedInTheRestOfALedWithoutAnotherShot) {
  ScanBench bench;
  bench.rig.rests_s[kCallForLed1] = 30;
  std::stop_source stop;
  bench.control.cancel = stop.get_token();
  std::chrono::steady_clock::time_point asked;
  bench.on_status = [&](const ScanStatus& status) {
    if (status.phase != ScanPhase::kCooling) return;
    EXPECT_EQ(status.why, "LED 1 cools, 30 s");
    asked = std::chrono::steady_clock::now();
    stop.request_stop();
  };
  const Result<ScanOutcome> stopped = bench.scan();
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted) << stopped.error().message();
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count(), 1);
  EXPECT_EQ(bench.rig.takes(), 1) << "the dark shot, and no other";
  EXPECT_FALSE(bench.rig.is_lit());
}

TEST(Scan, IsPausedInTheRestOfALed) {
  ScanBench bench;
  bench.rig.rests_s[kCallForLed1] = 0.5;
  std::atomic<bool> pause = false;
  bench.control.pause = &pause;
  std::vector<ScanPhase> phases;
  bench.on_status = [&](const ScanStatus& status) {
    if (phases.empty() || phases.back() != status.phase) phases.push_back(status.phase);
    pause = status.phase == ScanPhase::kCooling && std::ranges::count(phases, ScanPhase::kPaused) == 0;
  };
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  const auto rest = std::ranges::find(phases, ScanPhase::kCooling);
  ASSERT_GE(phases.end() - rest, 4);
  EXPECT_THAT(std::vector(rest, rest + 4), testing::ElementsAre(ScanPhase::kCooling, ScanPhase::kPaused,
                                                                ScanPhase::kExposing, ScanPhase::kCooling))
      << "the pause does not wait for the end of the rest";
  EXPECT_EQ(bench.objection(), "");
}

TEST(Scan, IsMeteringAgainAfterAPauseAndAFaultOfItsTestShots) {
  ScanBench bench;
  bench.request.exposure.exposure_us = 0;
  std::atomic<bool> pause = false;
  bench.control.pause = &pause;
  bench.rig.camera_faults[2] = test::SimulatedRig::Fault::kNoAnswer;
  bench.rig.on_take = [&](int take) {
    if (take == 1) pause = true;
  };
  bench.on_status = [&](const ScanStatus& status) {
    if (status.phase == ScanPhase::kPaused) pause = false;
  };
  ASSERT_TRUE(bench.scan());
  std::vector<ScanPhase> phases;  // until the first frame is taken
  for (const ScanStatus& status : bench.statuses) {
    if (status.exposure_us > 0) break;
    if (phases.empty() || phases.back() != status.phase) phases.push_back(status.phase);
  }
  EXPECT_THAT(phases, testing::ElementsAre(ScanPhase::kConnecting, ScanPhase::kMetering, ScanPhase::kPaused,
                                           ScanPhase::kMetering, ScanPhase::kRecovering, ScanPhase::kMetering,
                                           ScanPhase::kExposing));
  const auto meters_on = [](const ScanStatus& status) {
    return status.exposure_us > 0 && status.phase == ScanPhase::kMetering;
  };
  EXPECT_EQ(std::ranges::count_if(bench.statuses, meters_on), 0) << "the exposure is known";
}

TEST(Scan, GivesTheCodeOfWhatAFrameIsWarnedOf) {
  ScanBench bench;
  bench.request.exposure.exposure_us *= 8;
  bench.request.any_exposure = true;
  ASSERT_TRUE(bench.scan());
  EXPECT_EQ(bench.kept[0].finding.code, "") << "the dark shot";
  EXPECT_EQ(bench.kept[1].finding.code, "clipped");
}

TEST(Scan, EndsAtTheFirstFrameThatCannotBeUsedAndLeavesNoSession) {
  ScanBench bench;
  const double metered_us = bench.request.exposure.exposure_us;
  const std::vector<double> times_us = bench.rig.camera().shutter_times_us().value();
  for (const auto& [times, words] :
       {std::pair{32.0, "100 percent of a channel are full"}, {1 / 64.0, "it is dark"}}) {
    bench.request.exposure.exposure_us = nearest_time_us(times_us, times * metered_us);
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(outcome.error().message(), HasSubstr(words));
    EXPECT_THAT(outcome.error().message(), HasSubstr("LED 1"));
    EXPECT_FALSE(std::filesystem::exists(bench.request.session));
  }
  bench.request.exposure.exposure_us = nearest_time_us(times_us, 32 * metered_us);
  bench.request.bracket = 1 / 32.0;
  EXPECT_TRUE(bench.scan()) << "the brackets hold the cloth";
}

TEST(Scan, SaysOnceOfAllFramesThatTheyAreOverOrDark) {
  ScanBench bench;
  bench.request.any_exposure = true;
  const double metered_us = bench.request.exposure.exposure_us;
  for (const auto& [times, words] :
       {std::pair{32.0, "All 10 LEDs are over"}, {1 / 32.0, "All 10 LEDs are dark"}}) {
    bench.request.session.replace_filename(times > 1 ? "over.weft" : "dark.weft");
    bench.request.exposure.exposure_us =
        nearest_time_us(bench.rig.camera().shutter_times_us().value(), times * metered_us);
    const Result<ScanOutcome> outcome = bench.scan();
    ASSERT_TRUE(outcome) << outcome.error().message();
    ASSERT_FALSE(outcome->warnings.empty()) << words;
    EXPECT_THAT(outcome->warnings.front(), HasSubstr(words));
    EXPECT_THAT(outcome->warnings.front(), HasSubstr("scan again with a metered exposure"));
    const auto of_exposure = std::ranges::count_if(outcome->warnings, [](const std::string& warning) {
      return warning.find("of a channel") != std::string::npos ||
             warning.find("are dark") != std::string::npos;
    });
    EXPECT_EQ(of_exposure, 1) << "one sentence for one cause";
  }
}

TEST(Scan, WithoutACalibrationSaysThatFramesAreNotHeldAgainstTheLeds) {
  ScanBench bench;
  bench.request.calibration.clear();
  const Result<ScanOutcome> outcome = bench.scan();
  ASSERT_TRUE(outcome) << outcome.error().message();
  ASSERT_EQ(outcome->warnings.size(), 1u);
  EXPECT_THAT(outcome->warnings.front(), HasSubstr("no calibration"));
}

}  // namespace
}  // namespace weft::capture
