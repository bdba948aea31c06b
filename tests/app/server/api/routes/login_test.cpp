// SPDX-License-Identifier: Apache-2.0
// A browser comes in, over HTTP.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"

namespace weft::app {
namespace {

using testing::HasSubstr;

constexpr const char* kLogin = "/api/v1/login";

class Login : public testing::Test {
 protected:
  Login() {
    scripted_.rig.daemon.token = file_with("operate", "correct-horse-battery");
    scripted_.rig.daemon.look_token = file_with("look", "only-looking-around");
  }
  std::filesystem::path file_with(const std::string& name, const std::string& token) const {
    const std::filesystem::path file = scripted_.rig.file.parent_path() / name;
    std::ofstream(file) << token;
    EXPECT_EQ(chmod(file.c_str(), 0600), 0);
    return file;
  }
  /// "NAME=VALUE" of the cookie that a token gives.
  static std::string cookie_of(int port, const std::string& token) {
    const Answer answer = ask(port, "POST", kLogin, Json{{"token", token}}.dump());
    EXPECT_EQ(answer.status, 200) << answer.body;
    const std::size_t at = answer.head.find("Set-Cookie: ") + 12;
    return answer.head.substr(at, answer.head.find(';', at) - at);
  }
  static std::string own_origin(int port) { return fmt::format("http://127.0.0.1:{}", port); }

  ScriptedRig scripted_{"login"};
};

TEST_F(Login, GivesACookieThatScriptsAndOtherSitesDoNotGet) {
  const auto server = scripted_.started();
  const Answer answer = ask(server->port(), "POST", kLogin, R"({"token": "correct-horse-battery"})");
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.json()["role"], "operate");
  EXPECT_THAT(answer.head,
              testing::AllOf(HasSubstr(fmt::format("Set-Cookie: weft_{}=", server->port())),
                             HasSubstr("; HttpOnly"), HasSubstr("; SameSite=Strict"), HasSubstr("; Path=/")));
  for (const char* wrong : {R"({"token": "wrong"})", R"({"token": ""})"}) {
    EXPECT_EQ(ask(server->port(), "POST", kLogin, wrong).status, 401) << wrong;
  }
  for (const char* no_login : {"{}", R"({"token": 1})", R"({"token": "a", "b": 1})", "[]", ""}) {
    EXPECT_EQ(ask(server->port(), "POST", kLogin, no_login).status, 400) << no_login;
  }
  EXPECT_EQ(ask(server->port(), "POST", kLogin, R"({"token": "correct-horse-battery"})",
                {{"Origin", "http://evil.example"}})
                .status,
            403);
}

TEST_F(Login, LetsABrowserFollowEventsAndScan) {
  const auto server = scripted_.started();
  const int port = server->port();
  const std::string cookie = cookie_of(port, "correct-horse-battery");
  EXPECT_EQ(ask(port, "GET", "/api/v1/rig").json()["error"]["code"], "not_logged_in");
  EXPECT_EQ(ask(port, "GET", "/api/v1/rig", "", {{"Cookie", cookie}}).status, 200);
  RawClient follower(port);
  follower.say(request_text(port, "GET", "/api/v1/events", "", {{"Cookie", cookie}}));
  EXPECT_THAT(follower.hear(std::chrono::seconds(5), "event: status"), HasSubstr("200 OK"));
  const std::string scan = R"({"fabric": "satin"})";
  EXPECT_EQ(ask(port, "POST", "/api/v1/scan", scan, {{"Cookie", cookie}}).status, 403) << "no Origin";
  EXPECT_EQ(
      ask(port, "POST", "/api/v1/scan", scan, {{"Cookie", cookie}, {"Origin", own_origin(port)}}).status,
      202);
  wait_for_state(port, "idle", "correct-horse-battery");
}

TEST_F(Login, OfWhoMayLookChangesNothing) {
  const auto server = scripted_.started();
  const int port = server->port();
  const HeaderLines looking = {{"Cookie", cookie_of(port, "only-looking-around")},
                               {"Origin", own_origin(port)}};
  EXPECT_EQ(ask(port, "GET", "/api/v1/sessions", "", looking).status, 200);
  EXPECT_EQ(ask(port, "POST", "/api/v1/scan", R"({"fabric": "satin"})", looking).status, 403);
  EXPECT_EQ(ask(port, "POST", "/api/v1/logout", "", looking).status, 200);
}

TEST_F(Login, HoldsAcrossARestartOfTheServer) {
  auto server = scripted_.started();
  const int port = server->port();
  const std::string cookie = cookie_of(port, "correct-horse-battery");
  server.reset();
  scripted_.rig.daemon.port = port;
  server = scripted_.started();
  EXPECT_EQ(ask(port, "GET", "/api/v1/rig", "", {{"Cookie", cookie}}).status, 200);
  server.reset();
  file_with("operate", "another-horse-battery");
  server = scripted_.started();
  EXPECT_EQ(ask(port, "GET", "/api/v1/rig", "", {{"Cookie", cookie}}).status, 401) << "the token is another";
}

TEST_F(Login, BeginsAtAPageThatNeedsNoToken) {
  const auto server = scripted_.started();
  const Answer page =
      ask(server->port(), "GET", "/", "", {{"Sec-Fetch-Site", "cross-site"}, {"Sec-Fetch-Mode", "navigate"}});
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.head, testing::AllOf(HasSubstr("Content-Type: text/html"), HasSubstr("script-src 'self'"),
                                        HasSubstr("frame-ancestors 'none'")));
  const std::size_t script = page.body.find("/assets/");
  ASSERT_NE(script, std::string::npos);
  EXPECT_EQ(ask(server->port(), "GET", page.body.substr(script, page.body.find('"', script) - script)).status,
            200);
  EXPECT_EQ(ask(server->port(), "GET", "/viewer/NAME/ID", "",
                {{"Sec-Fetch-Site", "cross-site"}, {"Sec-Fetch-Mode", "navigate"}})
                .status,
            200)
      << "a place of the page that somebody shared";
  EXPECT_EQ(ask(server->port(), "GET", "/api/v1/rig?token=correct-horse-battery").status, 401)
      << "no token is read from an address";
}

}  // namespace
}  // namespace weft::app
