// SPDX-License-Identifier: Apache-2.0
// Whole scans with the bodies that a virtual rig can have: the firmware through libserialport, the camera
// through weft-camera and libgphoto2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "capture/board/led_board.h"
#include "capture/camera/camera_link.h"
#include "capture/camera/camera_profile.h"
#include "capture/raw/decode_raw.h"
#include "capture/rig.h"
#include "capture/scan/scan.h"
#include "core/base/files.h"
#include "solve/input/session_input.h"
#include "solve/run/solve_session.h"
#include "tests/virtual_rig/small_scene.h"
#include "virtual_rig/terminal/modem_lines.h"
#include "virtual_rig/virtual_rig.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

class ScanWithABody : public testing::Test {
 protected:
  void start(simulator::Body body, bool has_more_outputs = false) {
    virtual_rig::VirtualRigOptions options;
    options.below = options.polariser = has_more_outputs;
    options.scene = virtual_rig::small_scene();
    options.body = body;
    options.folder = folder_ / "rig";
    options.cache = folder_ / "cache";
    options.firmware = WEFT_FIRMWARE;
    options.bootloader_s = 0.02;
    auto rig = virtual_rig::VirtualRig::start(options);
    ASSERT_TRUE(rig) << rig.error().message();
    rig_ = std::move(*rig);
    setenv(virtual_rig::kModemVariable, (options.folder / "modem").c_str(), 1);
  }
  void TearDown() override { unsetenv(virtual_rig::kModemVariable); }

  /// A session of the rig's file; `profile` in place of its own.
  Result<capture::ScanOutcome> scan(double exposure_us, const std::string& profile = "",
                                    const capture::ScanControl& control = {}) {
    const Result<capture::Rig> file = capture::read_rig(folder_ / "rig" / "rig.toml");
    if (!file) return file.error();
    const auto board = capture::LedBoard::open({.port = file->board.port});
    if (!board) return board.error();
    capture::CameraLinkOptions options;
    options.profile = profile.empty() ? file->camera.profile : profile;
    options.port = file->camera.port;
    options.serial = file->camera.serial;
    const auto camera = capture::CameraLink::make(options);
    if (!camera) return camera.error();
    capture::ScanRequest request;
    request.session = folder_ / "cloth.weft";
    request.fabric = "satin";
    request.rig = file->name;
    request.calibration = file->scan.calibration;
    request.leds = leds_;
    request.exposure = {exposure_us, file->scan.iso, file->scan.f_number};
    request.below = file->below.has_value();
    const auto& states = file->polariser.states;
    request.polariser = {states, states.size() > 1, file->polariser.settle_s};
    return capture::scan(request, **board, **camera, {}, control);
  }

  /// All normals and albedos of a solve.
  static std::string solved(const Session& session, const fs::path& folder) {
    solve::SolveOptions options;
    options.method = "standard";
    options.output = folder;
    const Result<solve::SolveReport> report = solve::solve_session({session.folder, {}, {}}, options, {});
    EXPECT_TRUE(report) << report.error().message();
    return *sha256_of_file(folder / "normal.exr") + *sha256_of_file(folder / "albedo.exr");
  }

  /// How alike a frame is to what one LED's light gives, 1 where it is of that light alone.
  double likeness(const fs::path& frame, int led) const {
    const Result<RawFrame> decoded = capture::decode_raw(frame);
    EXPECT_TRUE(decoded) << decoded.error().message();
    double both = 0, own = 0, taken = 0;
    const View<const float> plane = rig_->frames().led(led);
    for (int y = 0; decoded && y < decoded->counts.height(); ++y) {
      for (int x = 0; x < decoded->counts.width(); ++x) {
        const double wanted = static_cast<double>(plane(x, y)), count = decoded->counts(x, y);
        both += wanted * count;
        own += wanted * wanted;
        taken += count * count;
      }
    }
    return both / std::sqrt(own * taken);
  }

  std::vector<int> leds_ = {1, 2, 3};  // of the scene; the board has ten outputs
  const fs::path folder_ = virtual_rig::fresh_folder();
  std::unique_ptr<virtual_rig::VirtualRig> rig_;
};

/// Shares of an exposure that the pins were on for, a line an exposure.
std::vector<Json> pin_shares(const fs::path& log) {
  std::vector<Json> shares;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) shares.push_back(Json::parse(line).at("pin_shares"));
  return shares;
}

TEST_F(ScanWithABody, WhoseTriggerReturnsAtOnceHasEachLedLitThroughoutItsFrame) {
  start(simulator::Body::kD80);
  const Result<capture::ScanOutcome> outcome = scan(1e6 / 30);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->session.state, "complete");
  EXPECT_EQ(outcome->frames_retaken, 0);
  ASSERT_EQ(outcome->session.lit().size(), 3u);
  for (const Shot* shot : outcome->session.lit())
    EXPECT_GT(likeness(outcome->session.path_of(*shot), shot->led), 0.999) << shot->file;
  const std::vector<Json> shares = pin_shares(folder_ / "rig" / "exposures.jsonl");
  EXPECT_THAT(shares,
              testing::ElementsAre(Json({0.0, 0.0, 0.0}), Json({1.0, 0.0, 0.0}), Json({0.0, 1.0, 0.0}),
                                   Json({0.0, 0.0, 1.0}), Json({1.0, 0.0, 0.0}), Json({0.0, 0.0, 0.0})));
}

TEST_F(ScanWithABody, WhoseSettingRoundsTheShutterTimeIsSolved) {
  start(simulator::Body::kD5100);
  std::string toml(capture::nikon_d5100_toml());
  const std::string exact = "shutter = \"shutterspeed2\"";
  toml.replace(toml.find(exact), exact.size(), "shutter = \"shutterspeed\"");
  const fs::path profile = folder_ / "rounded.toml";
  ASSERT_TRUE(write_file(profile, toml));
  const Result<capture::ScanOutcome> outcome = scan(16600, profile);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->session.document["exposure"]["exposure_us"], 16600) << "as the camera names 1/60 s";
  for (const Shot& shot : outcome->session.shots)
    EXPECT_NEAR(shot.exposure_us, 1e6 / 60, 1) << shot.file << ": as the photograph does";
  solve::SessionOptions options;
  options.folder = outcome->session.folder;
  const Result<solve::SolvePlan> plan = solve::plan_session(options);
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_EQ(plan->lit.size(), 3u);
  EXPECT_EQ(plan->repeats.size(), 1u);
}

TEST_F(ScanWithABody, WhoseAutoIsoIsOnSwitchesItOffWhereItCan) {
  start(simulator::Body::kD5100);
  for (const char* by_hand : {"camera auto_iso", "camera long_exposure_noise"})
    ASSERT_TRUE(rig_->command(by_hand));
  const Result<capture::ScanOutcome> outcome = scan(16600);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->frames_retaken, 0);
  for (const Shot& shot : outcome->session.shots)
    EXPECT_EQ(capture::decode_raw(outcome->session.path_of(shot)).value().shot.iso, 100) << shot.file;
}

TEST_F(ScanWithABody, WhoseAutoIsoCannotBeSwitchedOffSaysSoAtTheFirstFrame) {
  start(simulator::Body::kD80);  // whose profile has no such setting
  ASSERT_TRUE(rig_->command("camera auto_iso"));
  const Result<capture::ScanOutcome> outcome = scan(1e6 / 30);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, ErrorKind::kBadData);
  EXPECT_EQ(outcome.error().why, "ISO is 400, not 100");
  EXPECT_THAT(outcome.error().remedy, testing::HasSubstr("auto ISO off"));
  EXPECT_EQ(pin_shares(folder_ / "rig" / "exposures.jsonl").size(), 1u) << "no shot was taken again in vain";
}

TEST_F(ScanWithABody, WhoseNoiseReductionCannotBeSwitchedOffSaysThatItTakesTwice) {
  start(simulator::Body::kD80);
  ASSERT_TRUE(rig_->command("camera long_exposure_noise"));
  ASSERT_TRUE(rig_->command("light dim 1 0.01"));
  leds_ = {1};
  const Result<capture::ScanOutcome> outcome = scan(1.3e6);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->warnings, testing::Contains(testing::HasSubstr("takes their time twice")));
}

TEST_F(ScanWithABody, WhoseRigHasFilmsAndALightBelowTakesAllOfThemAndSolvesTheFirst) {
  start(simulator::Body::kD5100, true);
  const Result<capture::ScanOutcome> outcome = scan(16600);
  ASSERT_TRUE(outcome) << outcome.error().message();
  const Session& session = outcome->session;
  std::vector<std::string> files;
  for (const Shot& shot : session.shots) files.push_back(fs::path(shot.file).stem());
  EXPECT_THAT(files,
              testing::ElementsAre("00_led00_crossed", "01_led01_crossed", "02_led02_crossed",
                                   "03_led03_crossed", "04_led01_crossed", "05_led01_parallel",
                                   "06_led02_parallel", "07_led03_parallel", "08_below", "09_led00_crossed"));
  EXPECT_EQ(session.lit(Polariser::kParallel).size(), 3u);
  for (const Shot* shot : session.lit()) {
    EXPECT_EQ(shot->polariser, Polariser::kCrossed);
    EXPECT_GT(likeness(session.path_of(*shot), shot->led), 0.99) << shot->file;
  }
  const Shot& below = session.shots[8];
  EXPECT_EQ(below.role, ShotRole::kBelow);
  EXPECT_GT(below.exposure_us, 16600) << "metered: little comes through the cloth";
  EXPECT_EQ(session.document["plan"]["below"], true);
  EXPECT_NEAR(session.document["exposure"]["below_us"].get<double>(), below.exposure_us,
              0.02 * below.exposure_us);

  const std::string all = solved(session, folder_ / "all");
  Session first = session;
  std::erase_if(first.shots, [](const Shot& shot) {
    return shot.polariser == Polariser::kParallel || shot.role == ShotRole::kBelow;
  });
  ASSERT_TRUE(write_session(first));
  EXPECT_EQ(solved(first, folder_ / "first"), all) << "what is not solved changes no byte";
}

TEST_F(ScanWithABody, ThatWasStoppedAmongTheFilmsGoesOnThere) {
  start(simulator::Body::kD5100, true);
  std::stop_source stop;
  std::jthread stopper([&](const std::stop_token& end) {
    while (!end.stop_requested() && !is_there(folder_ / "cloth.weft" / "raw" / "05_led01_parallel.dng"))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    stop.request_stop();
  });
  const Result<capture::ScanOutcome> cut = scan(16600, "", {stop.get_token(), nullptr});
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().kind, ErrorKind::kInterrupted);
  const Result<capture::ScanOutcome> outcome = scan(16600);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_GE(outcome->frames_resumed, 6);
  EXPECT_EQ(outcome->session.shots.size(), 10u);
  EXPECT_EQ(outcome->session.state, "complete");
}

}  // namespace
}  // namespace weft
