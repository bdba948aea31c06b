// SPDX-License-Identifier: Apache-2.0
// The rig's states and sessions over HTTP, by a scan that does what the test says.
#include "app/server/rig_server.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "app/server/rig/rig_lock.h"
#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"
#include "tests/core/places.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kScan = "/api/v1/scan";

TEST(RigServer, ScansAClothAndShowsItsFrames) {
  ScriptedRig scripted("flow");
  const auto server = scripted.started();
  const int port = server->port();
  EXPECT_EQ(wait_for_state(port, "idle")["session"], Json());

  const Answer begun =
      ask(port, "POST", kScan, R"({"fabric": "satin", "session": "first", "metadata": {"id": "7"}})");
  ASSERT_EQ(begun.status, 202) << begun.body;
  EXPECT_EQ(begun.json(), (Json{{"session", "first"}, {"resumed", false}}));
  const Json status = wait_for_state(port, "idle");
  EXPECT_EQ(status["phase"], "complete");
  EXPECT_EQ(status["session"], "first");
  EXPECT_EQ(status["frames"], 4);
  EXPECT_EQ(status["devices"]["camera"]["says"]["serial"], "SN-0042");
  EXPECT_EQ(status["lock"]["pid"], getpid());

  const Answer picture = ask(port, "GET", "/api/v1/sessions/first/frames/2/thumbnail");
  ASSERT_EQ(picture.status, 200) << picture.body;
  EXPECT_THAT(picture.head, HasSubstr("image/png"));
  EXPECT_THAT(picture.body, StartsWith("\x89PNG"));
  const Json histogram = ask(port, "GET", "/api/v1/sessions/first/frames/2/histogram").json();
  // The columns from x = 597 on, of 640, are full: green, on both rows, has the same share as red and blue.
  for (const char* channel : {"red", "green", "blue"}) {
    EXPECT_EQ(histogram[channel]["bins"].size(), 64U);
    EXPECT_NEAR(histogram[channel]["clipped"].get<double>(), 43.0 / 640, 2.0 / 640) << channel;
  }
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(ask(port, "GET", "/api/v1/sessions/first/frames/" + std::to_string(i) + "/histogram").status,
              200);
  }
  const Json session = ask(port, "GET", "/api/v1/sessions/first").json();
  EXPECT_EQ(session["state"], "complete");
  EXPECT_EQ(session["frames"].size(), 4U);
  EXPECT_EQ(session["histograms_complete"], true);
  ASSERT_EQ(session["clipping_by_led"].size(), 3U) << session.dump(1);
  EXPECT_EQ(session["clipping_by_led"][1]["led"], 2);
  EXPECT_EQ(read_session(scripted.session("first"))->document["metadata"]["id"], "7");
}

/// The `frame` event of this index, from a stream of events.
Json frame_event(RawClient& follower, int index) {
  const std::string number = fmt::format("\"index\":{},", index);
  std::string heard = follower.hear(seconds(5), number);
  if (const std::string rest = heard.substr(std::min(heard.find(number), heard.size()));
      rest.find('\n') == std::string::npos) {
    heard += follower.hear(seconds(5), "\n\n");
  }
  const std::size_t at = heard.find(number), data = heard.rfind("data: ", at);
  if (at == heard.npos || data == heard.npos) return {};
  return Json::parse(heard.substr(data + 6, heard.find('\n', at) - data - 6), nullptr, false);
}

TEST(RigServer, MakesThumbnailAndHistogramOfEachFrameUnasked) {
  ScriptedRig scripted("thumbs");
  std::array<Gate, 4> gates;
  scripted.before = [&](int frame) -> Result<void> {
    gates.at(static_cast<std::size_t>(frame)).pass();
    return {};
  };
  const auto server = scripted.started();
  const int port = server->port();
  RawClient follower(port);
  follower.say(request_text(port, "GET", "/api/v1/events"));
  follower.hear(seconds(5), "\n\n");
  EXPECT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  const fs::path pictures = scripted.rig.daemon.state / "pictures";
  for (int i = 0; i < 4; ++i) {
    gates.at(static_cast<std::size_t>(i)).open();
    const Json kept = frame_event(follower, i);
    const auto began = std::chrono::steady_clock::now();
    const Result<Session> session = read_session(scripted.session("a"));
    const std::string digest = session && session->shots.size() > static_cast<std::size_t>(i)
                                   ? session->shots[static_cast<std::size_t>(i)].sha256
                                   : "";
    const auto is_made = [&] {
      return fs::exists(pictures / (digest + ".png")) && fs::exists(pictures / (digest + ".json"));
    };
    while (!is_made() && std::chrono::steady_clock::now() - began < seconds(10))
      std::this_thread::sleep_for(milliseconds(5));
    EXPECT_TRUE(is_made()) << "nobody asked for those of frame " << i << ", and they are not there";

    const std::string frame = "/api/v1/sessions/a/frames/" + std::to_string(i);
    EXPECT_THAT(kept.value("thumbnail", ""), StartsWith(frame + "/thumbnail?sha256=")) << kept;
    EXPECT_THAT(ask(port, "GET", frame + "/thumbnail").body, StartsWith("\x89PNG")) << i;
    EXPECT_EQ(kept.value("histogram", Json()), ask(port, "GET", frame + "/histogram").json()) << i;
    int photosites = 0;
    for (const Json& count : kept.value("/histogram/green/bins"_json_pointer, Json::array()))
      photosites += count.get<int>();
    EXPECT_EQ(photosites, 640 * 480 / 2) << i;
    const Json clipped = kept.value("clipped_rgb", Json::array({-1, -1, -1}));
    EXPECT_EQ(clipped[1], kept.value("/histogram/green/clipped"_json_pointer, Json())) << i;
  }
  wait_for_state(port, "idle");
}

TEST(RigServer, PausesResumesAndCancels) {
  ScriptedRig scripted("states");
  Gate at_one, at_two;
  scripted.before = [&](int frame) -> Result<void> {
    if (frame == 1) at_one.pass();
    if (frame == 2) at_two.pass();
    return {};
  };
  const auto server = scripted.started();
  const int port = server->port();
  for (const char* call : {"/api/v1/scan/pause", "/api/v1/scan/resume", "/api/v1/scan/cancel"}) {
    const Answer none = ask(port, "POST", call, "{}");
    EXPECT_EQ(none.status, 409) << call;
    EXPECT_EQ(none.json()["error"]["kind"], "try_again") << call;
  }
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  wait_for_state(port, "scanning");
  const Answer second = ask(port, "POST", kScan, R"({"fabric": "satin", "session": "b"})");
  EXPECT_EQ(second.status, 409) << second.body;
  EXPECT_THAT(second.json()["error"]["why"].get<std::string>(), HasSubstr("scans a"));

  ASSERT_EQ(ask(port, "POST", "/api/v1/scan/pause", "").status, 202);
  at_one.open();
  wait_for_state(port, "paused");
  ASSERT_EQ(ask(port, "POST", "/api/v1/scan/resume", "").status, 202);
  wait_for_state(port, "scanning");
  ASSERT_EQ(ask(port, "POST", "/api/v1/scan/cancel", "").status, 202);
  at_two.open();
  const Json cancelled = wait_for_state(port, "idle");
  EXPECT_EQ(cancelled["phase"], "cancelled");
  EXPECT_EQ(cancelled["resumable"], Json::array({"a"}));

  ASSERT_EQ(ask(port, "POST", "/api/v1/scan/resume", "").status, 202) << "a cancelled scan goes on";
  const Json status = wait_for_state(port, "idle");
  EXPECT_EQ(status["phase"], "complete");
  EXPECT_EQ(status["frames"], 4);
  EXPECT_EQ(ask(port, "POST", "/api/v1/scan/resume", "").status, 409) << "a finished one does not";
}

TEST(RigServer, SaysWhyAScanFailedAndLetsItBeResumed) {
  ScriptedRig scripted("fails");
  bool cable = false;
  scripted.before = [&](int frame) -> Result<void> {
    if (frame < 2 || cable) return {};
    return Error{ErrorKind::kNoDevice, "the camera is gone", "usb:001,007", "its cable was pulled",
                 "plug it in again"};
  };
  const auto server = scripted.started();
  const int port = server->port();
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  const Json failed = wait_for_state(port, "failed");
  EXPECT_EQ(failed["error"]["kind"], "no_device");
  EXPECT_THAT(failed["why"].get<std::string>(), HasSubstr("plug it in again"));
  EXPECT_EQ(failed["devices"]["camera"]["open"], false);
  cable = true;
  ASSERT_EQ(ask(port, "POST", kScan, R"({"session": "a"})").status, 202);
  EXPECT_EQ(wait_for_state(port, "idle")["frames"], 4);
}

std::vector<std::string> states_of_leds(const Json& status) {
  std::vector<std::string> states;
  for (const Json& led : status["leds"]) states.push_back(led["state"]);
  return states;
}

TEST(RigServer, GoesOnWithTheSameSessionAfterAFault) {
  ScriptedRig scripted("goes_on");
  std::atomic<bool> cable = false;
  scripted.before = [&](int frame) -> Result<void> {
    if (frame < 2 || cable) return {};
    return Error{ErrorKind::kNoDevice, "the LED board is gone", "/dev/weft-led", "its cable was pulled",
                 "plug it in again"};
  };
  const auto server = scripted.started();
  const int port = server->port();
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  const Json failed = wait_for_state(port, "failed");
  EXPECT_THAT(failed["can"], Contains("resume"));
  EXPECT_EQ(states_of_leds(failed), (std::vector<std::string>{"kept", "waiting", "waiting"}));
  const std::string first = read_session(scripted.session("a"))->shots.at(1).sha256;
  std::vector<std::string> at_first;
  scripted.devices = [&]() -> Result<void> {
    at_first = states_of_leds(ask(port, "GET", "/api/v1/rig").json());
    return {};
  };
  cable = true;
  ASSERT_EQ(ask(port, "POST", "/api/v1/scan/resume", "").status, 202);
  const Json status = wait_for_state(port, "idle");
  EXPECT_EQ(at_first, (std::vector<std::string>{"kept", "waiting", "waiting"})) << "as it goes on";
  EXPECT_EQ(status["session"], "a");
  EXPECT_EQ(status["frames"], 4);
  EXPECT_EQ(status["error"], Json());
  const Result<Session> session = read_session(scripted.session("a"));
  EXPECT_EQ(session->shots.size(), 4U);
  EXPECT_EQ(session->shots.at(1).sha256, first) << "what was kept stays";
}

TEST(RigServer, RefusesAnExposureThatTheCameraDoesNotHaveBeforeAnythingBegins) {
  ScriptedRig scripted("no_such_exposure");
  const auto server = scripted.started();
  const int port = server->port();
  EXPECT_EQ(wait_for_state(port, "idle")["devices"]["camera"]["exposures_us"], Json::array());
  ASSERT_EQ(ask(port, "POST", "/api/v1/rig/devices", R"({"open": true})").status, 200);
  const Json known = wait_for_state(port, "attended")["devices"]["camera"]["exposures_us"];
  EXPECT_EQ(known.size(), 5U) << known;
  for (const char* body : {R"({"fabric": "satin", "session": "a", "exposure_us": 16.2})",
                           R"({"fabric": "satin", "session": "a", "exposure_us": 9e8, "dry_run": true})"}) {
    const Answer refused = ask(port, "POST", kScan, body);
    EXPECT_EQ(refused.status, 400) << refused.body;
    EXPECT_EQ(refused.json()["error"]["why"], "it has 1 ms to 1.6 s") << refused.body;
  }
  EXPECT_EQ(ask(port, "POST", "/api/v1/rig/test-shot", R"({"led": 1, "exposure_us": 16.2})").status, 400);
  EXPECT_EQ(wait_for_state(port, "attended")["error"], Json()) << "no fault of the rig";
  EXPECT_FALSE(is_there(scripted.session("a")));
  const Answer shot = ask(port, "POST", "/api/v1/rig/test-shot", R"({"led": 1, "exposure_us": 16160})");
  ASSERT_EQ(shot.status, 202) << shot.body;
  const Json taken = ask(port, "GET", "/api/v1/rig/test-shots/1").json();
  EXPECT_NEAR(taken["exposure_us"].get<double>(), 1e6 / 60, 1e-6) << "the camera's nearest";
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "exposure_us": 16160})").status, 202);
}

TEST(RigServer, IsHeardEverySecondWhereNothingHappens) {
  ScriptedRig scripted("beats");
  const auto server = scripted.started();
  RawClient follower(server->port());
  follower.say(request_text(server->port(), "GET", "/api/v1/events"));
  follower.hear(seconds(5), "\n\n");
  for (int beat = 0; beat < 2; ++beat) {
    EXPECT_THAT(follower.hear(seconds(8), "heartbeat"), HasSubstr("event: heartbeat")) << beat;
    follower.hear(seconds(1), "\n\n");
  }
}

TEST(RigServer, SaysThatADeviceDoesNotAnswer) {
  ScriptedRig scripted("silent");
  scripted.devices = []() -> Result<void> {
    return Error{ErrorKind::kTryAgain, "no answer", "/dev/weft-led", "no greeting", "flash it"};
  };
  const auto server = scripted.started();
  ASSERT_EQ(ask(server->port(), "POST", kScan, R"({"fabric": "satin"})").status, 202);
  EXPECT_EQ(wait_for_state(server->port(), "failed")["error"]["where"], "/dev/weft-led");
}

TEST(RigServer, WaitsForADeviceThatIsNotThereYet) {
  ScriptedRig scripted("nodevice");
  std::atomic<bool> plugged = false;
  scripted.devices = [&]() -> Result<void> {
    if (plugged) return {};
    return Error{ErrorKind::kNoDevice, "no LED board", "/dev/weft-led", "nothing there", "plug it in"};
  };
  const auto server = scripted.started();
  const int port = server->port();
  const auto wait_for_why = [&] {
    const auto deadline = std::chrono::steady_clock::now() + seconds(5);
    Json status;
    do {
      status = wait_for_state(port, "connecting");
    } while (status["why"] == "" && std::chrono::steady_clock::now() < deadline);
    EXPECT_THAT(status["why"].get<std::string>(), HasSubstr("no LED board: /dev/weft-led"));
    EXPECT_EQ(status["devices"]["board"]["open"], false) << "it is still searched for";
  };
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  wait_for_why();
  ASSERT_EQ(ask(port, "POST", "/api/v1/scan/cancel", "").status, 202);
  EXPECT_EQ(wait_for_state(port, "idle")["phase"], "cancelled");

  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  wait_for_why();
  plugged = true;
  const Json complete = wait_for_state(port, "idle");
  EXPECT_EQ(complete["phase"], "complete");
  EXPECT_EQ(complete["why"], "");
}

TEST(RigServer, OutlivesAnExceptionOfItsScan) {
  ScriptedRig scripted("throws");
  int calls = 0;
  scripted.before = [&](int) -> Result<void> {
    if (++calls == 1) throw std::bad_alloc();
    if (calls == 2) throw std::runtime_error("a bug");
    return {};
  };
  const auto server = scripted.started();
  const int port = server->port();
  for (const auto& [kind, why] :
       {std::pair("try_again", "not enough memory"), std::pair("internal", "a bug")}) {
    ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
    const Json failed = wait_for_state(port, "failed");
    EXPECT_EQ(failed["error"]["kind"], kind);
    EXPECT_THAT(failed["why"].get<std::string>(), HasSubstr(why));
  }
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  EXPECT_EQ(wait_for_state(port, "idle")["phase"], "complete");
}

TEST(RigServer, WritesWhatHappenedToItsLog) {
  ScriptedRig scripted("log");
  scripted.refuse = {1, 1, ShotRole::kLit, {}, {"dark", 0.01, {}}, "LED 1 is dark"};
  scripted.before = [](int frame) -> Result<void> {
    if (frame < 2) return {};
    return Error{ErrorKind::kTryAgain, "the camera hangs", "camera", "no answer", "switch it off and on"};
  };
  auto server = scripted.started();
  ASSERT_EQ(ask(server->port(), "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  wait_for_state(server->port(), "failed");
  server.reset();
  std::vector<std::string> events;
  Json failed, refused;
  for (const Json& line : json_lines(scripted.rig.daemon.state / "log" / "weft.jsonl")) {
    events.push_back(line.value("event", "no JSON"));
    if (events.back() == "scan_failed") failed = line;
    if (events.back() == "frame_refused") refused = line;
  }
  EXPECT_THAT(events, testing::ElementsAre("daemon_began", "scan_began", "frame_refused", "frame", "frame",
                                           "scan_failed", "daemon_ended"));
  EXPECT_EQ(failed["error"]["where"], "camera");
  EXPECT_EQ(refused["code"], "dark");
}

TEST(RigServer, CannotBePausedWhileTheScanEnds) {
  ScriptedRig scripted("finishing");
  Gate gate;
  scripted.at_end = [&] { gate.pass(); };
  const auto server = scripted.started();
  const int port = server->port();
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  const auto deadline = std::chrono::steady_clock::now() + seconds(5);
  while (wait_for_state(port, "scanning")["phase"] != "finishing" &&
         std::chrono::steady_clock::now() < deadline) {
  }
  const Answer pause = ask(port, "POST", "/api/v1/scan/pause", "{}");
  EXPECT_EQ(pause.status, 409) << pause.body;
  EXPECT_EQ(pause.json()["error"]["what"], "the scan is about to end");
  gate.open();
  EXPECT_EQ(wait_for_state(port, "idle")["phase"], "complete");
}

TEST(RigServer, ScansWithACalibrationWhoseCheckFailedOnlyForAReason) {
  ScriptedRig scripted("moved");
  const std::filesystem::path folder = scripted.rig.file.parent_path();
  const std::filesystem::path calibration = folder / "calibrations" / "one";
  std::filesystem::create_directories(folder / "calibrations" / "checks");
  std::filesystem::copy(source_folder() / "testdata/schemas/weft.calibration-1.2-measured", calibration,
                        std::filesystem::copy_options::recursive);
  const Result<Calibration> read = read_calibration(calibration);
  ASSERT_TRUE(read) << read.error().message();
  scripted.rig.scan.calibration = calibration;
  const auto checked = [&](const char* name, const char* date, bool passed) {
    std::filesystem::create_directories(folder / "calibrations" / "checks" / name);
    ASSERT_TRUE(write_json(folder / "calibrations" / "checks" / name / "result.json",
                           {{"schema", "weft.calibration-check/1"},
                            {"date", date},
                            {"of", "session"},
                            {"calibration", read->id},
                            {"passed", passed},
                            {"numbers", {{"cost_mean_deg", 0.82}, {"cost_worst_deg", 2.1}}}}));
  };
  checked("a", "2026-11-01T10:00:00Z", true);
  checked("b", "2026-11-02T10:00:00Z", false);
  const auto server = scripted.started();
  const int port = server->port();
  const Answer refused = ask(port, "POST", kScan, R"({"fabric": "satin"})");
  EXPECT_EQ(refused.status, 422) << refused.body;
  EXPECT_EQ(refused.json()["error"]["code"], "rig_moved");
  EXPECT_THAT(refused.body, HasSubstr("0.82 degrees on average, 2.1 at worst"));
  EXPECT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "accept_moved": "only colours count"})").status,
            202);
  wait_for_state(port, "idle");
  checked("c", "2026-11-03T10:00:00Z", true);
  EXPECT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin"})").status, 202) << "it was mended";
  wait_for_state(port, "idle");
}

TEST(RigServer, ScansOnceForAClickThatComesTwice) {
  ScriptedRig scripted("clicks");
  scripted.rig.scan.session_name = "{fabric}_{count}";
  const auto server = scripted.started();
  const int port = server->port();
  constexpr const char* kClick = R"({"fabric": "silk", "request_id": "click-1"})";
  const Answer first = ask(port, "POST", kScan, kClick), second = ask(port, "POST", kScan, kClick);
  EXPECT_EQ(first.status, 202) << first.body;
  EXPECT_EQ(second.status, 202) << second.body;
  EXPECT_EQ(first.json(), second.json());
  wait_for_state(port, "idle");
  EXPECT_EQ(ask(port, "POST", kScan, kClick).json(), first.json());
  EXPECT_EQ(ask(port, "GET", "/api/v1/rig").json()["state"], "idle") << "nothing began";
  const Answer another = ask(port, "POST", kScan, R"({"fabric": "silk", "request_id": "click-2"})");
  EXPECT_NE(another.json()["session"], first.json()["session"]);
  EXPECT_EQ(ask(port, "POST", kScan, R"({"fabric": "silk", "request_id": 7})").status, 400);
  wait_for_state(port, "idle");
}

TEST(RigServer, TakesUpTheSessionThatTheSameRequestBegan) {
  ScriptedRig scripted("takesup");
  scripted.rig.scan.session_name = "{fabric}_{count}";
  scripted.leave_unfinished("linen_001");
  const auto server = scripted.started();
  const int port = server->port();
  const Answer resumed = ask(port, "POST", kScan, R"({"fabric": "linen"})");
  EXPECT_EQ(resumed.status, 202);
  EXPECT_EQ(resumed.json(),
            (Json{{"session", "linen_001"}, {"resumed", true}, {"frames", 1}, {"frames_planned", 4}}));
  EXPECT_EQ(wait_for_state(port, "idle")["frames"], 4);
  const Answer begun = ask(port, "POST", kScan, R"({"fabric": "linen"})");
  EXPECT_EQ(begun.json(), (Json{{"session", "linen_002"}, {"resumed", false}}));
  wait_for_state(port, "idle");
}

TEST(RigServer, FindsUnfinishedSessionsWhenItStarts) {
  ScriptedRig scripted("finds");
  scripted.leave_unfinished("left");
  fs::create_directories(scripted.session("broken"));
  std::ofstream(scripted.session("broken") / "session.json") << "{";
  fs::create_directory_symlink("/", scripted.session("link"));
  const auto server = scripted.started();
  const int port = server->port();
  EXPECT_EQ(wait_for_state(port, "idle")["resumable"], Json::array({"left"}));
  const Json sessions = ask(port, "GET", "/api/v1/sessions").json()["sessions"];
  ASSERT_EQ(sessions.size(), 2U) << sessions.dump(1);
  for (const Json& each : sessions)
    EXPECT_EQ(each["state"], each["name"] == "left" ? "capturing" : "unreadable");
  EXPECT_EQ(ask(port, "GET", "/api/v1/sessions/broken").status, 422);

  const Answer resumed = ask(port, "POST", kScan, R"({"session": "left"})");
  ASSERT_EQ(resumed.status, 202) << resumed.body;
  EXPECT_EQ(resumed.json()["resumed"], true);
  EXPECT_EQ(wait_for_state(port, "idle")["frames"], 4);
  EXPECT_EQ(read_session(scripted.session("left"))->fabric, "linen");
}

TEST(RigServer, NeverOverwritesASession) {
  ScriptedRig scripted("never");
  scripted.rig.scan.session_name = "{fabric}_{count}";
  scripted.leave_unfinished("linen_001");
  Session finished = read_session(scripted.session("linen_001")).value();
  finished.state = "complete";
  ASSERT_TRUE(write_session(finished));
  const auto server = scripted.started();
  const Answer again = ask(server->port(), "POST", kScan, R"({"fabric": "linen", "session": "linen_001"})");
  EXPECT_EQ(again.status, 409);
  EXPECT_EQ(again.json()["error"]["kind"], "cannot_create");
  EXPECT_EQ(ask(server->port(), "GET", "/api/v1/next-name?fabric=linen").json()["session"], "linen_002");
  EXPECT_EQ(ask(server->port(), "POST", kScan, R"({"fabric": "linen"})").json()["session"], "linen_002");
  wait_for_state(server->port(), "idle");
}

TEST(RigServer, TellsItsEventsToWhoFollows) {
  ScriptedRig scripted("events");
  Gate gate;
  scripted.before = [&](int frame) -> Result<void> {
    if (frame == 2) gate.pass();
    return {};
  };
  HttpLimits limits;
  limits.heartbeat_s = 0.3;
  const auto server = scripted.started(limits);
  const int port = server->port();
  RawClient follower(port);
  follower.say(request_text(port, "GET", "/api/v1/events"));
  EXPECT_THAT(follower.hear(seconds(5), "\n\n"), HasSubstr("event: status")) << "first of all how things are";
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  const std::string frames = follower.hear(seconds(5), "/api/v1/sessions/a/frames/1/thumbnail");
  EXPECT_THAT(frames, HasSubstr("event: frame"));
  EXPECT_THAT(frames, HasSubstr("\"index\":1,"));
  EXPECT_THAT(follower.hear(seconds(5), "heartbeat"), HasSubstr("event: heartbeat"));
  gate.open();
  const std::string rest = follower.hear(seconds(5), "\"phase\":\"complete\"");
  EXPECT_THAT(rest, HasSubstr("\"index\":3"));

  // One that comes back is told what it missed: the frame it saw last was number 1.
  const std::size_t id_at = frames.rfind("id: ", frames.find("\"index\":1"));
  ASSERT_NE(id_at, std::string::npos) << frames;
  const std::string id = frames.substr(id_at + 4, frames.find('\n', id_at) - id_at - 4);
  RawClient again(port);
  again.say(request_text(port, "GET", "/api/v1/events", "", {{"Last-Event-ID", id}}));
  const std::string missed = again.hear(seconds(5), "\"phase\":\"complete\"");
  EXPECT_THAT(missed, testing::AllOf(HasSubstr("\"index\":2"), HasSubstr("\"index\":3"),
                                     testing::Not(HasSubstr("\"index\":1,"))));
}

TEST(RigServer, EndsWithinThreeSecondsInTheMiddleOfAScan) {
  ScriptedRig scripted("ends");
  Gate gate;
  scripted.before = [&](int frame) -> Result<void> {
    if (frame == 1) gate.pass();
    return {};
  };
  auto server = scripted.started();
  const int port = server->port();
  ASSERT_EQ(ask(port, "POST", kScan, R"({"fabric": "satin", "session": "a"})").status, 202);
  wait_for_state(port, "scanning");
  RawClient follower(port), silent(port);
  follower.say(request_text(port, "GET", "/api/v1/events"));
  EXPECT_THAT(follower.hear(seconds(5), "\n\n"), HasSubstr("200"));
  const auto began = std::chrono::steady_clock::now();
  EXPECT_FALSE(server->stop()) << "the shot on its way does not end";
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  EXPECT_LT(took_s, 3.0);
  EXPECT_TRUE(follower.closed_within(milliseconds(100)));
  EXPECT_TRUE(silent.closed_within(milliseconds(100)));
  gate.open();
  server.reset();
  EXPECT_FALSE(fs::exists(scripted.rig.daemon.state / "address"));
  EXPECT_EQ(read_session(scripted.session("a"))->shots.size(), 1U) << "cancelled after the shot on its way";
}

TEST(RigServer, IsTheOnlyOneOfItsRig) {
  ScriptedRig scripted("only");
  auto first = scripted.started();
  EXPECT_EQ(address_of_owner(scripted.rig).value(), first->address());
  const auto second = scripted.start();
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::kTryAgain);
  EXPECT_THAT(second.error().message(), HasSubstr("process " + std::to_string(getpid())));
  first.reset();
  EXPECT_EQ(address_of_owner(scripted.rig).value(), std::nullopt);
  EXPECT_TRUE(scripted.start());
}

TEST(RigServer, SharesNothingWithThatOfAnotherRig) {
  ScriptedRig north("north"), south("south");
  const auto a = north.started(), b = south.started();
  ASSERT_EQ(ask(a->port(), "POST", kScan, R"({"fabric": "satin", "session": "same"})").status, 202);
  ASSERT_EQ(ask(b->port(), "POST", kScan, R"({"fabric": "wool", "session": "same"})").status, 202);
  wait_for_state(a->port(), "idle");
  wait_for_state(b->port(), "idle");
  EXPECT_EQ(ask(a->port(), "GET", "/api/v1/sessions/same").json()["fabric"], "satin");
  EXPECT_EQ(ask(b->port(), "GET", "/api/v1/sessions/same").json()["fabric"], "wool");
}

TEST(RigServer, SaysThatItsPortIsTaken) {
  ScriptedRig north("taken"), south("late");
  const auto first = north.started();
  south.rig.daemon.port = first->port();
  const auto second = south.start();
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::kTryAgain) << second.error().message();
}

TEST(RigServer, IsOpenToTheNetworkOnlyWithAToken) {
  ScriptedRig scripted("network");
  scripted.rig.daemon.host = "0.0.0.0";
  const auto open = scripted.start();
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().kind, ErrorKind::kUsage) << open.error().message();

  scripted.rig.daemon.token = scripted.rig.file.parent_path() / "token";
  std::ofstream(scripted.rig.daemon.token) << "0123456789abcdef\n";
  fs::permissions(scripted.rig.daemon.token, fs::perms::owner_read);
  const auto server = scripted.started();
  EXPECT_EQ(ask(server->port(), "GET", "/api/v1/rig").status, 401);
  EXPECT_EQ(
      ask(server->port(), "GET", "/api/v1/rig", "", {{"Authorization", "Bearer 0123456789abcdeF"}}).status,
      401);
  wait_for_state(server->port(), "idle", "0123456789abcdef");
}

}  // namespace
}  // namespace weft::app
