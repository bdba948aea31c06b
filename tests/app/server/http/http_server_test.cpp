// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/http_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/app/server/raw_client.h"

namespace weft::app {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

TEST(HttpServer, GivesASlowReaderAllForAsLongAsSomethingLeaves) {
  constexpr std::size_t kBytes = 24'000'000;
  EventLog events;
  HttpLimits limits;
  limits.write_deadline_s = 0.3;
  const std::vector<Route> routes = {
      {"GET", "/large", [](const Call&) -> Result<Reply> {
         return Reply{200, "application/octet-stream", std::string(kBytes, 'a')};
       }}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, limits);
  ASSERT_TRUE(server) << server.error().message();
  RawClient reader((*server)->port());
  ASSERT_TRUE(reader.say(request_text((*server)->port(), "GET", "/large")));
  std::size_t heard = 0;
  for (int pause = 0; pause < 12; ++pause) {
    std::this_thread::sleep_for(milliseconds(100));
    heard += reader.hear_some(2'000'000).size();
  }
  heard += reader.hear(std::chrono::seconds(5)).size();
  EXPECT_GT(heard, kBytes) << "1.2 s in all, four times the deadline";
}

TEST(HttpServer, EndsWhileASlowReaderStillReads) {
  EventLog events;
  HttpLimits limits;
  limits.write_deadline_s = 0.3;
  const std::vector<Route> routes = {
      {"GET", "/large", [](const Call&) -> Result<Reply> {
         return Reply{200, "application/octet-stream", std::string(64'000'000, 'a')};
       }}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, limits);
  ASSERT_TRUE(server) << server.error().message();
  RawClient reader((*server)->port());
  ASSERT_TRUE(reader.say(request_text((*server)->port(), "GET", "/large")));
  reader.hear_some(100'000);
  std::jthread reading([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      reader.hear_some(200'000);
      std::this_thread::sleep_for(milliseconds(20));
    }
  });
  const auto began = std::chrono::steady_clock::now();
  (*server)->stop();
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  EXPECT_LT(took_s, 2) << "the deadline is 0.3 s and does not begin again";
}

/// A disk that hangs holds the calls that read from it, and no other.
TEST(HttpServer, AnswersOthersWhileEveryThreadOfAKindWaits) {
  std::atomic<bool> hangs = true;
  EventLog events;
  HttpLimits limits;
  limits.disk = 2, limits.waiting = 3;
  const auto said = [](const Call&) -> Result<Reply> { return json_reply({{"status", "ok"}}); };
  const std::vector<Route> routes = {{"GET", "/files/{name}",
                                      [&](const Call& call) {
                                        hangs.wait(true);
                                        return said(call);
                                      }},
                                     {"GET", "/health", said, false, Pool::kAtOnce},
                                     {"GET", "/state", said, false, Pool::kQuick}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, limits);
  ASSERT_TRUE(server) << server.error().message();
  const int port = (*server)->port();
  std::vector<RawClient> held;
  for (int i = 0; i < 4; ++i) {
    held.emplace_back(port);
    ASSERT_TRUE(held.back().say(request_text(port, "GET", "/files/a?i=1")));
  }
  Answer refused;
  for (int tries = 0; tries < 10 && refused.status != 503; ++tries) {
    held.emplace_back(port);
    held.back().say(request_text(port, "GET", "/files/b"));
    refused = parsed(held.back().hear(milliseconds(100)));
  }
  held.pop_back();
  EXPECT_EQ(refused.status, 503) << "two are answered, three wait";
  EXPECT_EQ(held.size(), 5U);
  std::vector<double> took_ms;
  for (int i = 0; i < 40; ++i) {
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(ask(port, "GET", i % 2 == 0 ? "/health" : "/state").status, 200);
    took_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count());
  }
  std::ranges::sort(took_ms);
  EXPECT_LT(took_ms[20], 50) << "median, ms; the longest took " << took_ms.back();
  hangs = false;
  hangs.notify_all();
  for (RawClient& client : held) EXPECT_EQ(parsed(client.hear(std::chrono::seconds(5))).status, 200);
}

TEST(HttpServer, TellsWhoComesBackWithAnEventItDoesNotKnowHowThingsAre) {
  EventLog events;
  for (int i = 1; i <= 600; ++i) events.add("status", {{"step", i}});
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, {{"GET", "/events", {}}}, events, {});
  ASSERT_TRUE(server) << server.error().message();
  const auto heard_after = [&](const std::string& id) {
    RawClient client((*server)->port());
    client.say(request_text((*server)->port(), "GET", "/events", "", {{"Last-Event-ID", id}}));
    return client.hear(std::chrono::seconds(5), "\"step\":600}");
  };
  const std::string newest = events.id_of(events.current());
  const std::string boot = newest.substr(0, newest.find('.') + 1);
  for (const std::string& unknown : {std::string("999999999999999999"), std::string("1.600"), boot + "601",
                                     boot + "10", boot + "x", std::string("0")}) {
    EXPECT_THAT(heard_after(unknown), testing::AllOf(HasSubstr("event: gap"), HasSubstr("id: " + newest)))
        << unknown;
  }
  const std::string missed = heard_after(boot + "598");
  EXPECT_THAT(missed, testing::AllOf(HasSubstr("\"step\":599"), testing::Not(HasSubstr("gap"))));
  events.close();
}

}  // namespace
}  // namespace weft::app
