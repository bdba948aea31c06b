// SPDX-License-Identifier: Apache-2.0
#include "tests/app/server/scripted_rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include "capture/raw/decode_raw.h"
#include "capture/scan/histogram.h"
#include "core/base/files.h"
#include "simulator/camera/dng_writer.h"
#include "tests/app/server/raw_client.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

class NoLamps : public capture::Lamps {
 public:
  int leds() const override { return 3; }
  Result<double> light(std::span<const int>, double) override { return 0.0; }
  Result<void> recover() override { return {}; }
  bool has_more_outputs() const override { return false; }
  Result<void> polarise(Polariser) override { return {}; }
  Result<std::vector<double>> can_light_s() override { return std::vector<double>{40, 12.5}; }
};

class NoCamera : public capture::Camera {
 public:
  Result<capture::CameraFacts> connect() override {
    capture::CameraFacts facts;
    facts.model = "D5100";
    facts.serial = "SN-0042";
    return facts;
  }
  Result<capture::CameraFacts> set(const capture::ExposureSettings&) override { return connect(); }
  Result<std::vector<double>> shutter_times_us() override {
    return std::vector<double>{1000, 12500, 1e6 / 60, 1e6 / 50, 1.6e6};
  }
  Result<capture::Photograph> take(const fs::path&, const std::function<void()>&) override {
    return capture::Photograph{};
  }
  Result<std::string> look() override { return std::string("\xff\xd8\xff\xd9"); }
  Result<void> stop_looking() override { return {}; }
  Result<capture::CameraFacts> recover() override { return connect(); }
};

/// Counts that rise from left to right, so that some are full.
RawFrame ramp(int led) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>({640, 480});
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      frame.counts(x, y) =
          static_cast<std::uint16_t>(std::min(15520, led == 0 ? 610 + x % 3 : 600 + 25 * x + led));
    }
  }
  frame.black = {{{600, 600}, {600, 600}}};
  frame.white = 15520;
  frame.shot = {"Lumitex", "Virtual D5100", "SN-0042", 1e6 / 60, 100, 8};
  return frame;
}

Session read_or_make(const capture::ScanRequest& request) {
  if (is_there(request.session)) return read_session(request.session).value();
  Session session;
  session.folder = request.session;
  session.fabric = request.fabric;
  session.cloth_height_mm = request.cloth_height_mm;
  session.rig = request.rig;
  session.state = "capturing";
  session.document = {{"schema", "weft.session/1.1"},
                      {"metadata", request.metadata},
                      {"plan", {{"leds", {1, 2, 3}}, {"repeat", false}}}};
  EXPECT_TRUE(make_writable_folder(request.session / "raw"));
  EXPECT_TRUE(write_session(session));
  return session;
}

capture::KeptFrame take(Session& session, int index) {
  Shot shot;
  shot.index = index;
  shot.led = index;
  shot.role = index == 0 ? ShotRole::kDark : ShotRole::kLit;
  shot.file = fmt::format("raw/{:02}_led{:02}.dng", index, index);
  shot.exposure_us = 1e6 / 60;
  shot.f_number = 8;
  const RawFrame frame = ramp(index);
  EXPECT_TRUE(simulator::write_dng(session.path_of(shot), frame));
  shot.sha256 = sha256_of_file(session.path_of(shot)).value();
  session.shots.push_back(shot);
  EXPECT_TRUE(write_session(session));
  return {shot, capture::histogram_rgb(frame), {}};
}

}  // namespace

ScriptedRig::ScriptedRig(const std::string& name) {
  // A folder of its own: a catalogue's thread is not waited for, and closes its file when it comes to that.
  static std::atomic<int> count = 0;
  const fs::path folder =
      fs::path(testing::TempDir()) / fmt::format("weft_{}_{}_{}", name, getpid(), count++);
  fs::remove_all(folder);
  fs::create_directories(folder);
  rig.file = folder / "rig.toml";
  rig.name = name;
  rig.leds = 3;
  rig.scan.sessions = folder / "scans";
  rig.daemon.port = 0;
  rig.daemon.state = folder / "state";
}

ScriptedRig::~ScriptedRig() {
  std::error_code ignored;
  fs::remove_all(rig.file.parent_path(), ignored);
}

Result<std::unique_ptr<RigServer>> ScriptedRig::start(const HttpLimits& limits) {
  const capture::OpenDevices open = [this](const capture::Rig&) -> Result<capture::RigDevices> {
    if (Result<void> there = devices(); !there) return std::move(there).error();
    return capture::RigDevices{std::make_unique<NoLamps>(), std::make_unique<NoCamera>()};
  };
  const RunScan run = [this](const capture::ScanRequest& request, capture::Lamps&, capture::Camera& camera,
                             const capture::ScanEvents& events, const capture::ScanControl& control) {
    EXPECT_TRUE(camera.connect());
    return scan(request, events, control);
  };
  return RigServer::start(rig, open, run, {.limits = limits, .own_token = own_token, .say = {}});
}

std::unique_ptr<RigServer> ScriptedRig::started(const HttpLimits& limits) {
  Result<std::unique_ptr<RigServer>> server = start(limits);
  if (!server) ADD_FAILURE() << server.error().message();
  return server ? std::move(*server) : nullptr;
}

Result<capture::ScanOutcome> ScriptedRig::scan(const capture::ScanRequest& request,
                                               const capture::ScanEvents& events,
                                               const capture::ScanControl& control) const {
  Session session = read_or_make(request);
  const int resumed = static_cast<int>(session.shots.size());
  capture::ScanStatus status;
  status.frames_planned = frames;
  const auto tell = [&](capture::ScanPhase phase, int led) {
    status.phase = phase;
    status.led = led;
    status.frames = static_cast<int>(session.shots.size());
    events.status(status);
  };
  tell(capture::ScanPhase::kConnecting, 0);
  if (refuse) events.refused(*refuse);
  for (int i = resumed; i < frames; ++i) {
    tell(capture::ScanPhase::kExposing, i);
    if (Result<void> may = before(i); !may) return std::move(may).error();
    if (*control.pause) tell(capture::ScanPhase::kPaused, 0);
    while (*control.pause && !control.cancel.stop_requested()) std::this_thread::sleep_for(milliseconds(2));
    if (control.cancel.stop_requested()) {
      return Error{ErrorKind::kInterrupted, "scan cancelled", request.session.string(), "", "run it again"};
    }
    events.kept(take(session, i));
  }
  tell(capture::ScanPhase::kFinishing, 0);
  at_end();
  session.state = "complete";
  EXPECT_TRUE(write_session(session));
  tell(capture::ScanPhase::kComplete, 0);
  capture::ScanOutcome outcome;
  outcome.session = std::move(session);
  outcome.frames_resumed = resumed;
  return outcome;
}

void ScriptedRig::leave_unfinished(const std::string& name) const {
  capture::ScanRequest request;
  request.session = session(name);
  request.fabric = "linen";
  request.rig = rig.name;
  Session session = read_or_make(request);
  take(session, 0);
}

std::vector<Json> json_lines(const fs::path& file) {
  std::vector<Json> documents;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) documents.push_back(Json::parse(line, nullptr, false));
  return documents;
}

Json wait_for_state(int port, const std::string& state, const std::string& token) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  HeaderLines headers;
  if (!token.empty()) headers["Authorization"] = "Bearer " + token;
  Json status;
  do {
    const Answer answer = ask(port, "GET", "/api/v1/rig", "", headers);
    if (answer.status != 200) break;
    status = answer.json();
    if (status["state"] == state) return status;
    std::this_thread::sleep_for(milliseconds(5));
  } while (std::chrono::steady_clock::now() < deadline);
  ADD_FAILURE() << "not " << state << " within 5 s: " << status.dump();
  return status;
}

}  // namespace weft::app
