// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/http_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
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
  limits.door.write_deadline_s = 0.3;
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
  limits.door.write_deadline_s = 0.3;
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
  limits.threads[Pool::kDisk] = 2, limits.waiting = 3;
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

/// Which threads answer a call is known before it is parsed: the same words must lead to the same call then.
TEST(HttpServer, AnswersACallByItsOwnThreadsAlone) {
  std::atomic<bool> hangs = true;
  EventLog events;
  HttpLimits limits;
  limits.threads[Pool::kQuick] = 1;
  const auto ok = [](const Call&) -> Result<Reply> { return json_reply({{"status", "ok"}}); };
  const auto hang = [&](const Call& call) {
    hangs.wait(true);
    return ok(call);
  };
  const std::vector<Route> routes = {{"GET", "/devices", ok, false, Pool::kQuick},
                                     {"POST", "/devices", hang, false, Pool::kDevices},
                                     {"GET", "/files/{name}", hang},
                                     {"GET", "/events", {}}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, limits);
  ASSERT_TRUE(server) << server.error().message();
  const int port = (*server)->port();
  for (const char* other :
       {"/%65vents", "/f%69les/a", "/files%2fa", "/files/a%2fb", "/files/", "/devices/"}) {
    EXPECT_EQ(ask(port, "GET", other).status, 404) << other << " is no other spelling of a call";
  }
  EXPECT_EQ(ask(port, "DELETE", "/files/a").status, 405);
  RawClient opens(port), reads(port);
  ASSERT_TRUE(opens.say(request_text(port, "POST", "/devices", "{}")));
  ASSERT_TRUE(reads.say(request_text(port, "GET", "/files/a%62")));
  EXPECT_EQ(ask(port, "GET", "/devices").status, 200) << "the one quick thread waits for no device";
  hangs = false;
  hangs.notify_all();
  for (RawClient* client : {&opens, &reads}) {
    EXPECT_EQ(parsed(client->hear(std::chrono::seconds(5))).status, 200);
  }
  events.close();
}

Result<Reply> said(const std::string& words) {
  return json_reply({{"said", words}});
}

const HeaderLines kKept = {{"Connection", "keep-alive"}};

/// Requests of one connection that come at once are answered one after another, whichever pool is quicker.
TEST(HttpServer, AnswersTheRequestsOfAConnectionInTheirOrder) {
  EventLog events;
  const std::vector<Route> routes = {
      {"GET", "/slow",
       [](const Call&) {
         std::this_thread::sleep_for(milliseconds(50));
         return said("slow");
       }},
      {"GET", "/quick", [](const Call&) { return said("quick"); }, false, Pool::kQuick},
      {"GET", "/at-once", [](const Call&) { return said("at once"); }, false, Pool::kAtOnce},
      {"POST", "/echo", [](const Call& call) { return said(call.body); }}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, {});
  ASSERT_TRUE(server) << server.error().message();
  const int port = (*server)->port();
  RawClient client(port);
  const auto request = [&](const char* target) { return request_text(port, "GET", target, "", kKept); };
  client.say(request("/slow") + request("/at-once") + request_text(port, "POST", "/echo", "first", kKept) +
             request("/quick") + request("/none") + request_text(port, "POST", "/echo", "last"));
  const std::string heard = client.hear(std::chrono::seconds(5));
  std::size_t at = 0;
  for (const char* next : {"200 OK", "slow", "200 OK", "at once", "200 OK", "first", "200 OK", "quick",
                           "404 Not Found", "no such call", "200 OK", "Connection: close", "last"}) {
    at = heard.find(next, at);
    ASSERT_NE(at, std::string::npos) << next << " is not in its place in\n" << heard;
  }
}

TEST(HttpServer, ClosesAfterAMalformedRequestWhatItAnsweredBefore) {
  EventLog events;
  const std::vector<Route> routes = {{"GET", "/a", [](const Call&) { return said("a"); }}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, {});
  ASSERT_TRUE(server) << server.error().message();
  RawClient client((*server)->port());
  client.say(request_text((*server)->port(), "GET", "/a", "", kKept) + "GET a HTTP/1.1\r\n\r\n" +
             request_text((*server)->port(), "GET", "/a", "", kKept));
  const std::string heard = client.hear(std::chrono::seconds(5));
  EXPECT_THAT(heard, testing::AllOf(testing::StartsWith("HTTP/1.1 200 OK"), HasSubstr("HTTP/1.1 400")));
  EXPECT_EQ(heard.find("\"said\""), heard.rfind("\"said\"")) << "what follows a malformed one is not read";
}

TEST(HttpServer, KeepsAConnectionUntilItHasBeenIdleForLong) {
  EventLog events;
  HttpLimits limits;
  limits.door.idle_s = 0.4;
  limits.door.request_deadline_s = 0.2;
  const std::vector<Route> routes = {{"GET", "/a", [](const Call&) { return said("a"); }}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, limits);
  ASSERT_TRUE(server) << server.error().message();
  const std::string request = request_text((*server)->port(), "GET", "/a", "", kKept);
  RawClient client((*server)->port());
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(client.say(request)) << i;
    EXPECT_EQ(parsed(client.hear(std::chrono::seconds(5), "\"a\"}")).status, 200) << i;
    std::this_thread::sleep_for(milliseconds(250));
  }
  EXPECT_TRUE(client.closed_within(std::chrono::seconds(2)));

  RawClient half((*server)->port());
  ASSERT_TRUE(half.say(request));
  half.hear(std::chrono::seconds(5), "\"a\"}");
  half.say("GET /a HT");
  EXPECT_THAT(half.hear(std::chrono::seconds(2)), HasSubstr("HTTP/1.1 408"))
      << "a later request has its deadline";
}

/// What clients do not take waits at the door, not in the threads that make answers.
TEST(HttpServer, AnswersOthersBesideClientsThatDoNotRead) {
  EventLog events;
  HttpLimits limits;
  limits.threads[Pool::kQuick] = 1;
  const Reply large = {200, "application/octet-stream", std::string(8'000'000, 'a')};
  const std::vector<Route> routes = {
      {"GET", "/large", [large](const Call&) -> Result<Reply> { return large; }, false, Pool::kQuick},
      {"GET", "/small", [](const Call&) { return said("small"); }, false, Pool::kQuick}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, limits);
  ASSERT_TRUE(server) << server.error().message();
  const int port = (*server)->port();
  std::vector<RawClient> deaf;
  for (int i = 0; i < 6; ++i) {
    deaf.emplace_back(port);
    deaf.back().say(request_text(port, "GET", "/large", "", kKept));
  }
  const auto began = std::chrono::steady_clock::now();
  EXPECT_EQ(ask(port, "GET", "/small").status, 200);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  EXPECT_LT(took_s, 5) << "the one thread waits for none of them, 2 s each";
}

TEST(HttpServer, GivesTheOldestAnswerUpWhereTooMuchIsNotTaken) {
  EventLog events;
  HttpLimits limits;
  limits.threads[Pool::kQuick] = 1;
  limits.door.answer_bytes = 40'000'000;
  const Reply large = {200, "application/octet-stream", std::string(24'000'000, 'a')};
  const std::vector<Route> routes = {
      {"GET", "/large", [large](const Call&) -> Result<Reply> { return large; }, false, Pool::kQuick},
      {"GET", "/small", [](const Call&) { return said("small"); }, false, Pool::kQuick}};
  const auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events, limits);
  ASSERT_TRUE(server) << server.error().message();
  const int port = (*server)->port();
  RawClient first(port), second(port), third(port);
  for (RawClient* client : {&first, &second}) {
    client->say(request_text(port, "GET", "/large"));
    ASSERT_THAT(client->hear(std::chrono::seconds(5), "H"), HasSubstr("H"));
  }
  // The one thread has handed both answers to the door before it answers the third client, and the door has
  // them before it reads that client's next request.
  for (int i = 0; i < 2; ++i) {
    third.say(request_text(port, "GET", "/small", "", kKept));
    EXPECT_EQ(parsed(third.hear(std::chrono::seconds(5), "small\"}")).status, 200) << i;
  }
  EXPECT_GT(second.hear(std::chrono::seconds(5)).size(), 23'990'000U) << "but for what was heard before";
  EXPECT_LT(first.hear(std::chrono::seconds(5)).size(), 23'990'000U);
}

class HttpFiles : public testing::Test {
 protected:
  HttpFiles() : file_(std::filesystem::path(testing::TempDir()) / "served.bin") {
    for (int i = 0; i < 100'000; ++i) text_ += static_cast<char>('a' + i % 26);
    std::ofstream(file_) << text_;
    const std::vector<Route> routes = {{"GET", "/file",
                                        [this](const Call&) -> Result<Reply> {
                                          Reply reply = {200, "application/octet-stream"};
                                          reply.tag = "t1";
                                          reply.keeping = Keeping::kForever;
                                          auto file = open_file_body(file_);
                                          if (!file) return std::move(file).error();
                                          reply.file = std::move(*file);
                                          return reply;
                                        },
                                        false, Pool::kFiles},
                                       {"GET", "/text", [](const Call&) -> Result<Reply> {
                                          Reply reply = {200, "text/plain", std::string(5000, 'x')};
                                          reply.keeping = Keeping::kAskAgain;
                                          reply.tag = "t2";
                                          return reply;
                                        }}};
    auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events_, {});
    EXPECT_TRUE(server) << server.error().message();
    server_ = std::move(*server);
  }
  ~HttpFiles() override { std::filesystem::remove(file_); }
  Answer get(const std::string& target, const HeaderLines& headers = {}) const {
    return ask(server_->port(), "GET", target, "", headers);
  }

  std::filesystem::path file_;
  std::string text_;
  EventLog events_;
  std::unique_ptr<HttpServer> server_;
};

TEST_F(HttpFiles, AreGivenWholeOrByARange) {
  const Answer whole = get("/file");
  EXPECT_EQ(whole.status, 200);
  EXPECT_EQ(whole.body, text_);
  EXPECT_THAT(whole.head,
              testing::AllOf(HasSubstr("Accept-Ranges: bytes"), HasSubstr("Content-Length: 100000"),
                             HasSubstr("ETag: \"t1\""), HasSubstr("private, max-age=31536000, immutable")));
  const Answer part = get("/file", {{"Range", "bytes=70000-"}});
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.body, text_.substr(70000));
  EXPECT_THAT(part.head, testing::AllOf(HasSubstr("Content-Range: bytes 70000-99999/100000"),
                                        HasSubstr("Content-Length: 30000")));
  EXPECT_EQ(get("/file", {{"Range", "bytes=1-3"}, {"If-Range", "\"t1\""}}).body, text_.substr(1, 3));
  EXPECT_EQ(get("/file", {{"Range", "bytes=1-3"}, {"If-Range", "\"t0\""}}).body, text_)
      << "it is another file now";
  EXPECT_EQ(get("/file", {{"Range", "bytes=1-3,7-9"}}).body, text_);
  const Answer beyond = get("/file", {{"Range", "bytes=100000-"}});
  EXPECT_EQ(beyond.status, 416);
  EXPECT_THAT(beyond.head, HasSubstr("Content-Range: bytes */100000"));
  EXPECT_EQ(beyond.json()["error"]["kind"], "usage");
  EXPECT_EQ(get("/text", {{"Range", "bytes=1-3"}}).body.size(), 5000U) << "only files have ranges";
}

TEST_F(HttpFiles, AreNotSentAgainToWhoHasThem) {
  for (const auto& [target, tag] : {std::pair("/file", "\"t1\""), std::pair("/text", "\"x\", W/\"t2\"")}) {
    const Answer unchanged = get(target, {{"If-None-Match", tag}});
    EXPECT_EQ(unchanged.status, 304) << target;
    EXPECT_EQ(unchanged.body, "") << target;
    EXPECT_THAT(unchanged.head,
                testing::AllOf(HasSubstr("ETag: \"t"), testing::Not(HasSubstr("Content-Length"))));
    EXPECT_EQ(get(target, {{"If-None-Match", "\"t\""}}).status, 200) << target;
  }
  const Answer text = get("/text", {{"Accept-Encoding", "gzip, br"}});
  EXPECT_EQ(text.body, std::string(5000, 'x')) << "a tag names these bytes and no compressed ones";
  EXPECT_THAT(text.head, HasSubstr("private, no-cache"));
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
