// SPDX-License-Identifier: Apache-2.0
// The link through the real weft-camera and libgphoto2 to a virtual D5100.
#include "capture/camera/camera_link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <csignal>

#include "tests/capture/camera/link_bench.h"

namespace weft::capture {
namespace {

using testing::HasSubstr;
using virtual_rig::VirtualCameraOptions;

TEST(CameraLink, KnowsTheCameraOnceItIsConnected) {
  VirtualCameraOptions options;
  options.serial = "6004711";
  options.battery = 0.62;
  LinkBench bench(options);
  bench.options().serial = "0006004711";
  const auto facts = bench.link().connect();
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_EQ(facts->model, "D5100");
  EXPECT_EQ(facts->serial, "6004711");
  EXPECT_EQ(facts->port, bench.options().port);
  EXPECT_NEAR(facts->battery, 0.62, 0.006);
}

TEST(CameraLink, IsMadeAmongAllDriversOfTheLibrary) {
  LinkBench bench;
  bench.options().environment.emplace_back("CAMLIBS", WEFT_CAMERA_DRIVERS);
  const auto facts = bench.link().connect();
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_EQ(facts->model, "D5100");
}

TEST(CameraLink, WatchesTheCamerasClockWhereItKnowsNone) {
  VirtualCameraOptions options;
  options.clock_offset_s = -3723.4;
  LinkBench bench(options);
  const auto facts = bench.link().connect();
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_LT(facts->clock_uncertainty_s, 0.5) << "that of a glance is more";
  EXPECT_NEAR(facts->clock_offset_s, -3723.4, facts->clock_uncertainty_s + 0.005);
}

TEST(CameraLink, TakesARememberedClockThatAGlanceAgreesWith) {
  VirtualCameraOptions options;
  options.serial = "6004711";
  LinkBench bench(options);
  ASSERT_TRUE(bench.link().connect());
  bench.drop_link();
  const ClockMemory memory(bench.options().state / "clock.json");
  const auto watched = memory.recall(seconds_since_1970());
  ASSERT_TRUE(watched) << "the clock that was watched is not kept";
  EXPECT_EQ(watched->serial, "6004711");

  // Off by no more than it says, which no glance can gainsay.
  const CameraClock nudged = {watched->clock.offset_s + 0.11, watched->clock.uncertainty_s + 0.11};
  memory.keep({watched->serial, nudged}, seconds_since_1970());
  const auto before = bench.link().connect();
  ASSERT_TRUE(before) << before.error().message();
  bench.drop_link();
  memory.keep(*watched, seconds_since_1970());
  const auto after = bench.link().connect();
  ASSERT_TRUE(after) << after.error().message();
  EXPECT_NEAR(before->clock_offset_s - after->clock_offset_s, 0.11, 1e-6);
}

TEST(CameraLink, WatchesTheClockAgainWhereItWasSetOrIsAnotherCameras) {
  VirtualCameraOptions options;
  options.serial = "6004711";
  options.clock_offset_s = 60;
  for (const RememberedClock& wrong :
       {RememberedClock{"6004711", {57, 0.01}}, RememberedClock{"6004712", {60.1, 0.01}}}) {
    LinkBench bench(options);
    std::filesystem::create_directories(bench.options().state);
    ClockMemory(bench.options().state / "clock.json").keep(wrong, seconds_since_1970());
    const auto facts = bench.link().connect();
    ASSERT_TRUE(facts) << facts.error().message();
    EXPECT_LT(facts->clock_uncertainty_s, 0.5) << wrong.serial << ": that of a glance is more";
    EXPECT_NEAR(facts->clock_offset_s, 60, facts->clock_uncertainty_s + 0.005) << wrong.serial;
  }
}

TEST(ClockMemory, GrowsUnsureAndForgetsAfterAnHour) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "weft_clock_memory.json";
  const ClockMemory memory(file);
  memory.keep({"7", {-12.5, 0.02}}, 1000);
  const auto later = memory.recall(2000);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->clock.offset_s, -12.5);
  EXPECT_NEAR(later->clock.uncertainty_s, 0.12, 1e-12) << "0.02 s and a drift of 1e-4 over 1000 s";
  EXPECT_FALSE(memory.recall(999)) << "this machine's clock was set back";
  EXPECT_FALSE(memory.recall(4601)) << "over an hour ago";
  ASSERT_TRUE(write_file(file, "{\"schema\": \"weft.camera_clock/1.0\", \"serial\": 7}"));
  EXPECT_FALSE(memory.recall(2000)) << "not a clock";
  memory.keep({"7", {0, 0}}, 1000);
  memory.forget();
  EXPECT_FALSE(memory.recall(1000));
}

TEST(CameraLink, SetsAnExposureAndReadsItBack) {
  LinkBench bench;
  ASSERT_TRUE(bench.link().connect());
  const auto facts = bench.link().set({399000, 200, 11});
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_EQ(facts->exposure, (ExposureSettings{4e5, 200, 11}));
  const auto none = bench.link().set({16000, 100, 8});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(none.error().message(), HasSubstr("1/80 and 1/60"));
  const auto times = bench.link().shutter_times_us();
  ASSERT_TRUE(times) << times.error().message();
  EXPECT_TRUE(std::ranges::is_sorted(*times));
  EXPECT_EQ(times->front(), 250);
  EXPECT_EQ(times->back(), 3e7);
}

TEST(CameraLink, TakesTwentyPhotographs) {
  LinkBench bench;
  CameraLink& link = bench.ready();
  for (int i = 1; i <= 20; ++i) {
    int exposed = 0;
    const auto taken = link.take(bench.raw(i), [&] { ++exposed; });
    ASSERT_TRUE(taken) << i << ": " << taken.error().message();
    EXPECT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(i)), "");
    EXPECT_EQ(exposed, 1);
    EXPECT_EQ(taken->ending, "dng");
    EXPECT_EQ(taken->file, bench.raw(i).string() + ".dng");
    EXPECT_NEAR(taken->exposure.exposure_us, 1e6 / 60, 1);
    ASSERT_TRUE(taken->taken_s);
    EXPECT_NEAR(*taken->taken_s, taken->triggered_s, 0.2)
        << "seconds between trigger and the photograph's own time";
  }
  EXPECT_EQ(left_over(bench.folder() / "raw"), 0);
}

/// What a D80 needs, told that its trigger returns at once or, wrongly, that it blocks.
void use_d80(LinkBench& bench, const std::string& trigger, double readout_s = 5) {
  bench.change_profile({{"model = \"D5100\"", "model = \"D80\""},
                        {"trigger = \"blocks\"", "trigger = \"" + trigger + "\""},
                        {"readout_s = 5", "readout_s = " + std::to_string(readout_s)},
                        {"Internal RAM", "Memory card"}});
}

/// When, in seconds after the shot began, it was said that the shutter has closed.
double told_after_s(LinkBench& bench, Result<Photograph>& taken) {
  CameraLink& link = bench.ready();
  EXPECT_TRUE(link.set({1e6, 100, 8}));
  const auto begin = std::chrono::steady_clock::now();
  double told_s = 0;
  int times = 0;
  taken = link.take(bench.raw(1), [&] {
    told_s = seconds_since(begin);
    ++times;
  });
  EXPECT_EQ(times, 1);
  return told_s;
}

constexpr double kD80Closes_s = 1.08;  // its lag and the exposure

TEST(CameraLink, TellsThatTheShutterHasClosedWhereTheTriggerReturnsAtOnce) {
  LinkBench bench({.body = virtual_rig::CameraBody::kD80});
  use_d80(bench, "returns_at_once");
  Result<Photograph> taken = Photograph();
  const double told_s = told_after_s(bench, taken);
  ASSERT_TRUE(taken) << taken.error().message();
  EXPECT_EQ(wrong_with(*taken, 1), "");
  EXPECT_GE(told_s, kD80Closes_s);
  EXPECT_LT(told_s, 4) << "the photograph was there long before";
}

TEST(CameraLink, TellsSoTooEarlyWhereAProfileWronglySaysThatTheTriggerBlocks) {
  LinkBench bench({.body = virtual_rig::CameraBody::kD80});
  use_d80(bench, "blocks");
  Result<Photograph> taken = Photograph();
  EXPECT_LT(told_after_s(bench, taken), kD80Closes_s) << "then no test here tells the two kinds apart";
}

TEST(CameraLink, TellsSoWhenTheTimeIsOverWhereNoPhotographComes) {
  LinkBench bench({.body = virtual_rig::CameraBody::kD80});
  use_d80(bench, "returns_at_once", 2.5);
  ASSERT_TRUE(bench.camera().inject({"no_object", 1}));
  Result<Photograph> taken = Photograph();
  const double told_s = told_after_s(bench, taken);
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().what, "no photograph came") << taken.error().message();
  EXPECT_GE(told_s, 3) << "the exposure, and 2 s for a slow shutter";
  EXPECT_LT(told_s, 5);
}

TEST(CameraLink, RefusesAnotherCameraThanTheRigs) {
  LinkBench bench;
  bench.options().serial = "6009999";
  const auto facts = bench.link().connect();
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(facts.error().message(), HasSubstr("6000001, not 6009999"));
}

TEST(CameraLink, SendsAPersonToTheDialAndTheBattery) {
  VirtualCameraOptions off_m;
  off_m.dial_manual = false;
  VirtualCameraOptions low;
  low.battery = 0.04;
  for (const auto& [options, remedy] : {std::pair{off_m, "dial to M"}, std::pair{low, "charge"}}) {
    LinkBench bench(options);
    const auto facts = bench.link().connect();
    ASSERT_FALSE(facts) << remedy;
    EXPECT_EQ(facts.error().kind, ErrorKind::kBadData) << facts.error().message();
    EXPECT_THAT(facts.error().remedy, HasSubstr(remedy));
  }
}

TEST(CameraLink, SetsTheCameraToRaw) {
  VirtualCameraOptions options;
  options.raw = false;
  LinkBench bench(options);
  const auto taken = bench.ready().take(bench.raw(1), [] {});
  ASSERT_TRUE(taken) << taken.error().message();
  EXPECT_EQ(taken->ending, "dng");
}

TEST(CameraLink, SaysSoWhereTheCameraTakesNoRaw) {
  LinkBench bench;
  std::string toml(nikon_d5100_toml());
  const std::string_view right = "NEF (Raw)";
  toml.replace(toml.find(right), right.size(), "NEF (lossless)");
  bench.options().profile = bench.folder() / "body.toml";
  ASSERT_TRUE(write_file(bench.options().profile, toml));
  const auto facts = bench.link().connect();
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().kind, ErrorKind::kBadData) << facts.error().message();
  EXPECT_THAT(facts.error().message(), HasSubstr("imagequality"));
}

/// What somebody does to the camera between two shots: no photograph that is not as it was asked for is kept.
TEST(CameraLink, NoticesWhatSomebodyTurnsBetweenShots) {
  for (const char* fault : {"dial_turned", "battery_low", "raw_off", "exposure_changed", "auto_iso"}) {
    LinkBench bench;
    CameraLink& link = bench.ready();
    ASSERT_TRUE(bench.camera().inject({fault, 2}));
    ASSERT_TRUE(link.take(bench.raw(1), [] {})) << fault;
    const auto taken = link.take(bench.raw(2), [] {});
    ASSERT_FALSE(taken) << fault;
    EXPECT_EQ(taken.error().kind, ErrorKind::kBadData) << fault << ": " << taken.error().message();
    EXPECT_FALSE(taken.error().remedy.empty());
    EXPECT_EQ(left_over(bench.folder() / "raw"), 0);
  }
}

TEST(CameraLink, PutsRawAndExposureRightWhenItConnectsAgain) {
  for (const char* fault : {"raw_off", "exposure_changed", "auto_iso"}) {
    LinkBench bench;
    CameraLink& link = bench.ready();
    ASSERT_TRUE(bench.camera().inject({fault, 1}));
    ASSERT_FALSE(link.take(bench.raw(1), [] {})) << fault;
    const auto facts = link.recover();
    ASSERT_TRUE(facts) << facts.error().message();
    EXPECT_NEAR(facts->exposure.exposure_us, 1e6 / 60, 1);
    const auto taken = link.take(bench.raw(1), [] {});
    EXPECT_TRUE(taken) << fault << ": " << taken.error().message();
  }
}

TEST(CameraLink, SwitchesOffWhatTheBodyWouldDoToPhotographs) {
  LinkBench bench;
  for (const char* by_hand : {"auto_iso", "long_exposure_noise"})
    ASSERT_TRUE(bench.camera().inject({by_hand, 1}));
  CameraLink& link = bench.ready();
  ASSERT_TRUE(link.set({2e6, 100, 8}));
  const auto begin = std::chrono::steady_clock::now();
  const auto taken = link.take(bench.raw(1), [] {});
  ASSERT_TRUE(taken) << taken.error().message();
  EXPECT_EQ(taken->exposure.iso, 100);
  EXPECT_LT(seconds_since(begin), 4) << "no dark photograph follows";
}

TEST(CameraLink, SaysOfALongExposureThatDoesNotComeThatItsNoiseMayBeReduced) {
  VirtualCameraOptions options;
  options.body = virtual_rig::CameraBody::kD80;
  LinkBench bench(options);
  bench.change_profile({{"model = \"D5100\"", "model = \"D80\""},
                        {"trigger = \"blocks\"", "trigger = \"returns_at_once\""},
                        {"readout_s = 5", "readout_s = 0.5"},
                        {"longexpnr = \"Off\"", ""},
                        {"\"Internal RAM\"", "\"Memory card\""}});
  ASSERT_TRUE(bench.camera().inject({"long_exposure_noise", 1}));
  CameraLink& link = bench.ready();
  ASSERT_TRUE(link.set({2e6, 100, 8}));
  const auto taken = link.take(bench.raw(1), [] {});
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().kind, ErrorKind::kTryAgain) << taken.error().message();
  EXPECT_THAT(taken.error().remedy, HasSubstr("noise reduction of long exposures off"));
}

TEST(CameraLink, SaysThatNoCameraIsThere) {
  LinkBench bench;
  bench.ready();
  bench.switch_off();
  const auto taken = bench.link().take(bench.raw(1), [] {});
  ASSERT_FALSE(taken);
  const auto begin = std::chrono::steady_clock::now();
  const auto facts = bench.link().recover();
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().kind, ErrorKind::kNoDevice) << facts.error().message();
  EXPECT_LT(seconds_since(begin), 4);
}

TEST(CameraLink, TakesNothingUntilItHasRecovered) {
  LinkBench bench;
  EXPECT_EQ(bench.link().take(bench.raw(1), [] {}).error().kind, ErrorKind::kTryAgain);
  CameraLink& link = bench.ready();
  ::kill(link.worker_pid(), SIGKILL);
  const auto crashed = link.take(bench.raw(1), [] {});
  ASSERT_FALSE(crashed);
  EXPECT_EQ(crashed.error().kind, ErrorKind::kTryAgain) << crashed.error().message();
  EXPECT_EQ(link.take(bench.raw(1), [] {}).error().what, "the camera is not connected");
  ASSERT_TRUE(link.recover());
  EXPECT_TRUE(link.take(bench.raw(1), [] {}));
}

TEST(CameraLink, LeavesNoProcessAndNoFolderBehind) {
  LinkBench bench;
  bench.options().state.clear();
  bench.ready();
  const pid_t worker = bench.link().worker_pid();
  ASSERT_EQ(::kill(worker, 0), 0);
  bench.drop_link();
  EXPECT_EQ(::kill(worker, 0), -1);
  EXPECT_EQ(errno, ESRCH) << "it is still there";
}

TEST(CameraLink, SaysWhereItsProgramShouldBe) {
  LinkBench bench;
  bench.options().worker = bench.folder() / "absent";
  const auto facts = bench.link().connect();
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().kind, ErrorKind::kNoInput);
  EXPECT_THAT(facts.error().message(), HasSubstr("absent"));
}

TEST(CameraLink, BlamesNoCameraForAProgramThatDoesNotStart) {
  LinkBench bench;
  bench.options().worker = "/bin/false";
  const auto facts = bench.link().connect();
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().kind, ErrorKind::kTryAgain);
  EXPECT_EQ(facts.error().what, "the camera's program does not start");
  EXPECT_THAT(facts.error().why, HasSubstr("code 1"));
}

TEST(CameraLink, SaysThatTheDiskTakesNoFileAndGoesOn) {
  LinkBench bench;
  CameraLink& link = bench.ready();
  const auto nowhere = link.take(bench.folder() / "nowhere" / "01", [] {});
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().kind, ErrorKind::kCannotCreate) << nowhere.error().message();
  const auto taken = link.take(bench.raw(2), [] {});
  ASSERT_TRUE(taken) << taken.error().message();
  EXPECT_EQ(wrong_with(*taken, 2), "");
}

}  // namespace
}  // namespace weft::capture
