// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/http_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

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
