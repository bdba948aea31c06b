// SPDX-License-Identifier: Apache-2.0
#include "app/server/page/served_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "app/server/http/http_server.h"
#include "tests/app/server/raw_client.h"

namespace weft::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Page : public testing::Test {
 protected:
  Page() {
    std::vector<Route> routes = page_routes();
    const std::vector<PageFile> built = {{"/assets/a.1f2e.js", "run();", "a long way to say run"},
                                         {"/assets/b.77.css", "p { color: red; color: red }", "short"}};
    for (Route& route : page_routes(built)) routes.push_back(std::move(route));
    auto server = HttpServer::start(0, {"127.0.0.1", ""}, routes, events_, {});
    EXPECT_TRUE(server) << server.error().message();
    server_ = std::move(*server);
  }
  Answer get(const std::string& path, const HeaderLines& headers = {}) const {
    return ask(server_->port(), "GET", path, "", headers);
  }
  EventLog events_;
  std::unique_ptr<HttpServer> server_;
};

TEST_F(Page, IsGivenPackedToWhoTakesThat) {
  const Answer plain = get("/"), packed = get("/", {{"Accept-Encoding", "gzip, br"}});
  EXPECT_THAT(plain.body, AllOf(HasSubstr("<!doctype html>"), HasSubstr("/assets/")));
  EXPECT_THAT(packed.head, AllOf(HasSubstr("Content-Encoding: gzip"), HasSubstr("Vary: Accept-Encoding"),
                                 HasSubstr("Content-Type: text/html")));
  EXPECT_EQ(packed.body.substr(0, 2), "\x1f\x8b");
  EXPECT_LT(packed.body.size(), plain.body.size());
  const Answer longer = get("/assets/a.1f2e.js", {{"Accept-Encoding", "gzip"}});
  EXPECT_EQ(longer.body, "run();") << "packed it is longer";
  EXPECT_EQ(get("/assets/b.77.css", {{"Accept-Encoding", "gzip"}}).body, "short");
}

TEST_F(Page, IsAskedForAgainByItsTagAndItsAssetsNever) {
  for (const char* path : {"/", "/jobs"}) {
    const Answer first = get(path);
    EXPECT_THAT(first.head, HasSubstr("Cache-Control: public, no-cache")) << path;
    const std::size_t at = first.head.find("ETag: ") + 6;
    const std::string tag = first.head.substr(at, first.head.find('\r', at) - at);
    EXPECT_EQ(get(path, {{"If-None-Match", tag}}).status, 304) << path;
    EXPECT_EQ(get(path, {{"If-None-Match", tag}, {"Accept-Encoding", "gzip"}}).status, 200)
        << path << ": packed it is other bytes";
  }
  EXPECT_THAT(get("/assets/a.1f2e.js").head, AllOf(HasSubstr("public, max-age=31536000, immutable"),
                                                   HasSubstr("Content-Type: text/javascript")));
  EXPECT_EQ(get("/assets/none.js").status, 404);
  EXPECT_EQ(get("/index.html").status, 404) << "one file, one address";
}

TEST_F(Page, IsThereAtTheAddressOfEachScreen) {
  const std::string page = get("/").body;
  for (const char* path : {"/desk", "/sessions/2026-11-21_wool.2_001", "/viewer/a%20b/d043ba17c8aaa1fc",
                           "/viewer/a/maps/d043ba17", "/material/a/maps/d043ba17", "/calibrate", "/batches",
                           "/batches/0001", "/jobs", "/doctor", "/tour", "/library"}) {
    EXPECT_EQ(get(path).body, page) << path;
  }
  for (const char* path : {"/nothing", "/desks", "/viewer/a/b/c", "/api/v1/desk", "/api", "/desk.js"}) {
    EXPECT_THAT(get(path), AllOf(testing::Field(&Answer::status, 404),
                                 testing::Field(&Answer::head, HasSubstr("application/json"))))
        << path;
  }
}

// What a browser asks for where somebody typed an address, and nothing that a program asks for.
TEST_F(Page, AnswersAnUnknownAddressToWhoReadsIt) {
  const HeaderLines by_hand = {{"Accept", "text/html,application/xhtml+xml,*/*;q=0.8"}};
  const std::string page = get("/").body;
  for (const char* path : {"/nothing", "/viewer/a/b/c", "/a/b/c/d/e"}) {
    const Answer answer = get(path, by_hand);
    EXPECT_EQ(answer.status, 404) << path;
    EXPECT_EQ(answer.body, page) << path;
    EXPECT_THAT(answer.head, HasSubstr("default-src 'none'")) << path;
  }
  EXPECT_THAT(get("/api/v1/nothing", by_hand).head, HasSubstr("application/json"));
  EXPECT_THAT(get("/nothing").head, HasSubstr("application/json"));
}

TEST_F(Page, NamesNoFileThatIsNotThere) {
  const std::string page = get("/").body;
  const std::regex named("(?:src|href)=\"(/assets/[^\"]+)\"");
  int files = 0;
  for (std::sregex_iterator file(page.begin(), page.end(), named), end; file != end; ++file, ++files) {
    EXPECT_EQ(get((*file)[1]).status, 200) << (*file)[1];
  }
  EXPECT_GE(files, 2) << "a script and a style sheet";
}

TEST_F(Page, MayDoNothingButAskThisServer) {
  const std::string head = get("/").head;
  for (const char* rule :
       {"default-src 'none'", "script-src 'self'", "connect-src 'self'", "frame-ancestors 'none'",
        "base-uri 'none'", "require-trusted-types-for 'script'", "X-Content-Type-Options: nosniff",
        "Referrer-Policy: no-referrer", "Cross-Origin-Opener-Policy: same-origin"}) {
    EXPECT_THAT(head, HasSubstr(rule));
  }
  EXPECT_THAT(head, Not(HasSubstr("unsafe")));
}

}  // namespace
}  // namespace weft::app
