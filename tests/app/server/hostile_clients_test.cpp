// SPDX-License-Identifier: Apache-2.0
// Clients that break every rule, and what others notice of them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "bench/capture/malformed_request.h"
#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"

namespace weft::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

class HostileClients : public testing::Test {
 protected:
  void start(const HttpLimits& limits = {}) {
    server_ = scripted_.started(limits);
    port_ = server_->port();
  }
  /// Milliseconds that each of `count` good requests took, sorted.
  std::vector<double> good_requests_ms(int count) const {
    std::vector<double> took;
    for (int i = 0; i < count; ++i) {
      const auto began = std::chrono::steady_clock::now();
      const Answer answer = ask(port_, "GET", "/api/v1/rig");
      took.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count());
      EXPECT_EQ(answer.status, 200) << "request " << i;
    }
    std::ranges::sort(took);
    return took;
  }
  ScriptedRig scripted_{"hostile"};
  std::unique_ptr<RigServer> server_;
  int port_ = 0;
};

TEST_F(HostileClients, SilentOnesAreNotNoticedByAGoodOneAndAreDropped) {
  HttpLimits limits;
  limits.door.request_deadline_s = 1.5;
  start(limits);
  good_requests_ms(5);
  std::vector<RawClient> silent;
  for (int i = 0; i < 64; ++i) {
    silent.emplace_back(port_);
    ASSERT_TRUE(silent.back().connected()) << i;
    if (i % 2 == 1) silent.back().say("POST /api/v1/scan HTTP/1.1\r\nContent-Le");
  }
  const std::vector<double> took = good_requests_ms(50);
  const double median = took[25], worst = took.back();
  fmt::print("64 silent clients: a good one is answered in {:.1f} ms (median of 50), {:.1f} ms at most\n",
             median, worst);
  RecordProperty("median_us", static_cast<int>(1000 * median));
  // `weft bench server --part door` measures it (docs/measured/reliability.md); this holds on a busy machine.
  EXPECT_LT(median, 1000) << "at most " << worst << " ms";
  for (std::size_t i = 0; i < silent.size(); ++i) EXPECT_TRUE(silent[i].closed_within(seconds(10))) << i;
}

TEST_F(HostileClients, OneThatTricklesIsDroppedAtTheDeadline) {
  HttpLimits limits;
  limits.door.request_deadline_s = 0.5;
  start(limits);
  const auto began = std::chrono::steady_clock::now();
  RawClient slow(port_);
  while (slow.say("G") && std::chrono::steady_clock::now() - began < seconds(10)) {
    if (slow.closed_within(milliseconds(20))) break;
  }
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  EXPECT_GT(took_s, 0.3);
  EXPECT_LT(took_s, 5);
  EXPECT_EQ(good_requests_ms(1).size(), 1U);
}

TEST_F(HostileClients, MoreThanTheDoorHoldsPushOutTheOldest) {
  HttpLimits limits;
  limits.door.waiting = 8;
  start(limits);
  std::vector<RawClient> silent;
  for (int i = 0; i < 20; ++i) silent.emplace_back(port_);
  EXPECT_TRUE(silent[0].closed_within(seconds(5)));
  good_requests_ms(3);
}

TEST_F(HostileClients, AThousandMalformedRequestsLeaveItAnswering) {
  HttpLimits limits;
  limits.door.request_deadline_s = 1;
  scripted_.devices = []() -> Result<void> {  // what few become
    return Error{ErrorKind::kTryAgain, "the LED board does not answer", "", "", "plug it in"};
  };
  start(limits);
  std::mt19937 random(20261121);
  int answered = 0, taken = 0;
  for (int i = 0; i < 1000; ++i) {
    RawClient client(port_);
    ASSERT_TRUE(client.connected()) << i;
    client.say(bench::malformed_request(random, port_));
    client.end_of_words();
    const Answer answer = parsed(client.hear(seconds(5)));
    answered += answer.status != 0;
    taken += answer.status == 202 || answer.status == 200;
    if (answer.status >= 400) {
      ASSERT_TRUE(answer.json().contains("error")) << answer.body;
      ASSERT_TRUE(answer.status < 500 || answer.status == 505) << i << ": " << answer.body;
    }
  }
  EXPECT_GT(answered, 500) << "most were told what is wrong";
  EXPECT_LT(taken, 50);
  const std::vector<double> took = good_requests_ms(50);
  fmt::print(
      "after 1000 malformed requests a good one is answered in {:.1f} ms (median of 50), {:.1f} ms at most\n",
      took[25], took.back());
  EXPECT_LT(took[25], 1000);
}

TEST_F(HostileClients, NoPathLeadsOutOfTheSessions) {
  start();
  scripted_.leave_unfinished("real");
  std::ofstream(scripted_.rig.scan.sessions / "secret.txt") << "classified";
  for (const char* name : {"..",
                           "../state",
                           "..%2fstate",
                           "%2e%2e",
                           "%2e%2e%2fstate",
                           "..%5c..",
                           "%252e%252e%252f",
                           "real/../..",
                           "real%00",
                           "%c0%ae%c0%ae",
                           "real.weft/../secret.txt",
                           "/etc/passwd",
                           "%2fetc%2fpasswd",
                           "real/frames/0/../../..",
                           "real/frames/-1/thumbnail",
                           "real/frames/0x0/thumbnail",
                           "real/frames/99/thumbnail",
                           "real/frames/99999999999999/histogram",
                           "real/frames/%30%00/thumbnail",
                           "none"}) {
    const Answer answer = ask(port_, "GET", std::string("/api/v1/sessions/") + name);
    EXPECT_TRUE(answer.status == 400 || answer.status == 404) << name << ": " << answer.status << answer.body;
    EXPECT_TRUE(answer.json().contains("error")) << name;
    EXPECT_THAT(answer.body, testing::Not(HasSubstr("classified"))) << name;
  }
  EXPECT_EQ(ask(port_, "GET", "/api/v1/sessions/real").status, 200);
}

TEST_F(HostileClients, AFrameThatIsALinkOutOfItsSessionIsNotServed) {
  start();
  scripted_.leave_unfinished("a");
  scripted_.leave_unfinished("b");
  const Session a = read_session(scripted_.session("a")).value(),
                b = read_session(scripted_.session("b")).value();
  std::filesystem::remove(a.path_of(a.shots[0]));
  std::filesystem::create_symlink(b.path_of(b.shots[0]), a.path_of(a.shots[0]));
  EXPECT_EQ(ask(port_, "GET", "/api/v1/sessions/a/frames/0/thumbnail").status, 404);
  EXPECT_EQ(ask(port_, "GET", "/api/v1/sessions/b/frames/0/thumbnail").status, 200);
}

TEST_F(HostileClients, ADigestThatIsAPathLeadsNowhere) {
  start();
  scripted_.leave_unfinished("a");
  Session session = read_session(scripted_.session("a")).value();
  session.shots[0].sha256 = "../secret";
  ASSERT_TRUE(write_session(session));
  std::ofstream(scripted_.rig.daemon.state / "secret.json") << R"({"word": "classified"})";
  std::filesystem::create_directories(scripted_.rig.daemon.state / "pictures");
  const Answer answer = ask(port_, "GET", "/api/v1/sessions/a");
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.json()["frames"][0]["histogram"], Json()) << answer.body;
  EXPECT_EQ(ask(port_, "GET", "/api/v1/sessions/a/frames/0/histogram").status, 422);
}

TEST_F(HostileClients, ForeignPagesAreTurnedAway) {
  start();
  const std::string body = R"({"fabric": "satin"})";
  EXPECT_EQ(ask(port_, "GET", "/api/v1/rig", "", {{"Host", "evil.example"}}).status, 421);
  EXPECT_EQ(
      ask(port_, "POST", "/api/v1/scan", body, {{"Host", fmt::format("evil.example:{}", port_)}}).status,
      421);
  EXPECT_EQ(ask(port_, "GET", "/api/v1/rig", "", {{"Origin", "http://evil.example"}}).status, 403);
  EXPECT_EQ(ask(port_, "POST", "/api/v1/scan", body, {{"Origin", "null"}}).status, 403);
  EXPECT_EQ(ask(port_, "POST", "/api/v1/scan", body, {{"Content-Type", "text/plain"}}).status, 415);
  EXPECT_EQ(ask(port_, "OPTIONS", "/api/v1/scan").status, 405);
  EXPECT_EQ(ask(port_, "DELETE", "/api/v1/sessions").status, 405);
  EXPECT_EQ(ask(port_, "GET", "/api/v1/scan").status, 405);
  EXPECT_EQ(ask(port_, "GET", "/nothing").status, 404);
  EXPECT_EQ(wait_for_state(port_, "idle")["session"], Json());
}

TEST_F(HostileClients, ABodyThatIsTooLongIsRefusedWithoutReadingIt) {
  start();
  const Answer told = ask(port_, "POST", "/api/v1/scan", "", {{"Content-Length", "99999999999"}});
  EXPECT_EQ(told.status, 413);
  const Answer sent = ask(port_, "POST", "/api/v1/scan", std::string(1 << 20, ' '));
  EXPECT_EQ(sent.status, 413) << "one that sends it all the same reads its answer";
  EXPECT_EQ(ask(port_, "POST", "/api/v1/scan/pause", std::string(65536, ' ')).status, 409)
      << "64 kB are taken";
}

TEST_F(HostileClients, StreamsOfEventsAreLimitedAndFreeAgainOnceLeft) {
  HttpLimits limits;
  limits.streams = 4;
  start(limits);
  std::vector<RawClient> followers;
  for (int i = 0; i < 4; ++i) {
    followers.emplace_back(port_);
    followers.back().say(request_text(port_, "GET", "/api/v1/events"));
    EXPECT_THAT(followers.back().hear(seconds(5), "\n\n"), HasSubstr("event: status"));
  }
  const Answer fifth = ask(port_, "GET", "/api/v1/events");
  EXPECT_EQ(fifth.status, 503) << fifth.head;
  EXPECT_EQ(fifth.json()["error"]["kind"], "try_again");
  followers.clear();
  const auto began = std::chrono::steady_clock::now();
  std::string heard;
  while (heard.find("event: status") == std::string::npos) {
    ASSERT_LT(std::chrono::steady_clock::now() - began, seconds(5)) << heard;
    RawClient next(port_);
    next.say(request_text(port_, "GET", "/api/v1/events"));
    heard = next.hear(seconds(2), "\n\n");
  }
}

}  // namespace
}  // namespace weft::app
