// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"

namespace weft::app {
namespace {

using testing::HasSubstr;

TEST(RigClient, ScansAndFollows) {
  ScriptedRig scripted("client");
  const auto server = scripted.started();
  const Result<RigClient> client = RigClient::connect(server->address());
  ASSERT_TRUE(client) << client.error().message();
  EXPECT_EQ(client->get("/api/v1/rig")->at("state"), "idle");
  std::vector<int> frames;
  Json last;
  bool begun = false;
  const Result<void> followed = client->follow(
      [&](const RigClient::Event& event) {
        if (!begun) begun = client->post("/api/v1/scan", {{"fabric", "satin"}, {"session", "a"}}).has_value();
        if (event.name == "frame") frames.push_back(event.data["index"]);
        last = event.data;
        return event.name != "status" || event.data["phase"] != "complete" || event.data["state"] != "idle";
      },
      {});
  ASSERT_TRUE(followed) << followed.error().message();
  EXPECT_THAT(frames, testing::ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(last["session"], "a");
}

TEST(RigClient, PassesOnTheDaemonsErrors) {
  ScriptedRig scripted("clienterrors");
  const auto server = scripted.started();
  const RigClient client = RigClient::connect(server->address()).value();
  const Result<Json> refused = client.post("/api/v1/scan", {{"fabrik", "satin"}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(refused.error().where, "fabrik");
  EXPECT_THAT(refused.error().why, HasSubstr("'fabric'"));
  EXPECT_EQ(client.get("/api/v1/sessions/none").error().kind, ErrorKind::kNoInput);
}

TEST(RigClient, SaysThatNothingAnswers) {
  std::string address;
  {
    ScriptedRig scripted("clientnone");
    address = scripted.started()->address();
  }
  const Result<RigClient> client = RigClient::connect(address);
  ASSERT_FALSE(client);
  EXPECT_EQ(client.error().kind, ErrorKind::kTryAgain);
  EXPECT_THAT(client.error().remedy, HasSubstr("weft serve"));
  for (const char* none :
       {"", "127.0.0.1:80", "http://", "http://a", "http://a:0", "http://a:99999", "https://a:1"}) {
    ASSERT_FALSE(RigClient::connect(none)) << none;
    EXPECT_EQ(RigClient::connect(none).error().kind, ErrorKind::kUsage) << none;
  }
}

TEST(RigClient, StopsFollowingWhenAskedTo) {
  ScriptedRig scripted("clientstop");
  const auto server = scripted.started();
  const RigClient client = RigClient::connect(server->address()).value();
  std::stop_source stop;
  const auto began = std::chrono::steady_clock::now();
  const std::jthread soon([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop.request_stop();
  });
  EXPECT_TRUE(client.follow([](const RigClient::Event&) { return true; }, stop.get_token()));
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
}

TEST(RigClient, NoticesThatTheDaemonEnds) {
  ScriptedRig scripted("clientends");
  auto server = scripted.started();
  const RigClient client = RigClient::connect(server->address()).value();
  bool ending = false;
  std::jthread end;
  const Result<void> followed = client.follow(
      [&](const RigClient::Event&) {
        if (!ending) end = std::jthread([&] { server->stop(); });
        ending = true;
        return true;
      },
      {});
  ASSERT_FALSE(followed);
  EXPECT_EQ(followed.error().kind, ErrorKind::kTryAgain);
}

}  // namespace
}  // namespace weft::app
