// SPDX-License-Identifier: Apache-2.0
// Screens near a rig are black while its table is photographed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <vector>

#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"

namespace weft::app {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;
/// Milliseconds from the word that screens are to be black until the first shot.
double dark_before_the_first_shot_ms(ScriptedRig& scripted, const char* events) {
  using std::chrono::steady_clock;
  std::atomic<steady_clock::time_point> exposed{};
  scripted.before = [&](int) -> Result<void> {
    if (exposed.load() == steady_clock::time_point()) exposed = steady_clock::now();
    return {};
  };
  const auto server = scripted.started();
  RawClient follower(server->port());
  follower.say(request_text(server->port(), "GET", events));
  follower.hear(seconds(5), "\n\n");
  EXPECT_EQ(ask(server->port(), "POST", "/api/v1/scan", R"({"fabric": "satin"})").status, 202);
  EXPECT_THAT(follower.hear(seconds(5), "\"dark\":true"), HasSubstr("\"dark\":true"));
  const steady_clock::time_point dark = steady_clock::now();
  EXPECT_EQ(wait_for_state(server->port(), "idle")["dark"], false);
  return std::chrono::duration<double, std::milli>(exposed.load() - dark).count();
}

TEST(Screens, ThatFollowAreWaitedForToBecomeBlack) {
  ScriptedRig followed("black"), unfollowed("alone");
  followed.rig.daemon.page_dark_ms = unfollowed.rig.daemon.page_dark_ms = 400;
  EXPECT_GT(dark_before_the_first_shot_ms(followed, "/api/v1/events?screen=1"), 300);
  EXPECT_LT(dark_before_the_first_shot_ms(unfollowed, "/api/v1/events"), 200) << "no screen follows";
}

TEST(Screens, ThatFollowSayThatTheyWillBeBlackBeforeAScanOfDevicesThatAreOpen) {
  ScriptedRig scripted("announced");
  const auto server = scripted.started();
  const int port = server->port();
  ASSERT_EQ(ask(port, "POST", "/api/v1/rig/devices", R"({"open": true})").status, 200);
  RawClient follower(port);
  follower.say(request_text(port, "GET", "/api/v1/events?screen=1"));
  follower.hear(seconds(5), "\n\n");
  const auto begun = std::chrono::steady_clock::now();
  ASSERT_EQ(ask(port, "POST", "/api/v1/scan", R"({"fabric": "satin"})").status, 202);
  EXPECT_THAT(follower.hear(seconds(5), "\"dark_in_s\":0."), HasSubstr("\"dark\":false"));
  EXPECT_THAT(follower.hear(seconds(5), "\"dark\":true"), HasSubstr("\"dark\":true"));
  const std::chrono::duration<double> announced = std::chrono::steady_clock::now() - begun;
  EXPECT_GE(announced, Screens::kAnnounced) << announced.count() << " s";
  wait_for_state(port, "attended");
}

TEST(Screens, ThatTheClothDoesNotSeeAreLeftAlone) {
  ScriptedRig scripted("unseen");
  scripted.rig.daemon.is_screen_seen = false;
  std::vector<bool> dark;
  const std::unique_ptr<RigServer>* running = nullptr;
  scripted.before = [&](int) -> Result<void> {
    dark.push_back(ask((*running)->port(), "GET", "/api/v1/rig").json()["dark"].get<bool>());
    return {};
  };
  const auto server = scripted.started();
  running = &server;
  ASSERT_EQ(ask(server->port(), "POST", "/api/v1/scan", R"({"fabric": "satin"})").status, 202);
  wait_for_state(server->port(), "idle");
  EXPECT_THAT(dark, testing::AllOf(testing::Not(testing::IsEmpty()), testing::Each(false)));
}

}  // namespace
}  // namespace weft::app
