// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/http_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace weft::app {
namespace {

const GuardRules kLoopback = {"127.0.0.1", ""};
const GuardRules kWithToken = {"192.168.7.5", "correct-horse-battery"};

int status_of(const Visitor& visitor, const GuardRules& rules) {
  const auto refused = turned_away(visitor, rules);
  return refused ? refused->status : 0;
}

Visitor getting(const std::string& host, const std::string& origin = "") {
  return {"GET", host, origin, "", ""};
}

TEST(HttpGuard, LetsInItsOwnNamesAtAnyPort) {
  for (const char* host : {"127.0.0.1:8470", "127.0.0.1", "localhost:8470", "LOCALHOST", "localhost:9000"}) {
    EXPECT_EQ(status_of(getting(host), kLoopback), 0) << host;
  }
  EXPECT_EQ(status_of(getting("[::1]:8470"), {"::1", ""}), 0);
}

TEST(HttpGuard, TurnsAwayForeignNames) {
  for (const char* host :
       {"", "evil.example", "evil.example:8470", "127.0.0.1.evil.example", "localhost.evil.example",
        "192.168.7.5:8470", "[::1]:8470", "127.0.0.1@evil.example"}) {
    EXPECT_EQ(status_of(getting(host), kLoopback), 421) << host;
  }
}

TEST(HttpGuard, OnAllAddressesTakesAddressesButNoNames) {
  const GuardRules all = {"0.0.0.0", "correct-horse-battery"};
  const auto asked = [&](const std::string& host) {
    return status_of({"GET", host, "", "Bearer correct-horse-battery", ""}, all);
  };
  EXPECT_EQ(asked("10.1.2.3:8470"), 0);
  EXPECT_EQ(asked("[fe80::1]:8470"), 0);
  EXPECT_EQ(asked("evil.example:8470"), 421);
}

TEST(HttpGuard, TakesAnOriginOnlyWhereItIsTheHost) {
  EXPECT_EQ(status_of(getting("localhost:8470", "http://localhost:8470"), kLoopback), 0);
  for (const char* origin : {"http://evil.example", "null", "http://localhost:8471", "https://localhost:8470",
                             "http://127.0.0.1:8470"}) {
    EXPECT_EQ(status_of(getting("localhost:8470", origin), kLoopback), 403) << origin;
  }
}

TEST(HttpGuard, WantsTheWholeTokenWhereThereIsOne) {
  const auto asked = [](const std::string& authorization) {
    return status_of({"GET", "192.168.7.5:8470", "", authorization, ""}, kWithToken);
  };
  EXPECT_EQ(asked("Bearer correct-horse-battery"), 0);
  for (const char* wrong :
       {"", "Bearer ", "Bearer correct-horse-batterz", "Bearer correct-horse-batter",
        "Bearer correct-horse-battery ", "correct-horse-battery", "Basic correct-horse-battery"}) {
    EXPECT_EQ(asked(wrong), 401) << wrong;
  }
}

TEST(HttpGuard, LetsInTheNamesAndOriginsOfTheRigFile) {
  GuardRules rules = kLoopback;
  rules.names = {"rig.local"};
  rules.origins = {"https://rig.local"};
  EXPECT_EQ(status_of(getting("Rig.local:8470"), rules), 0);
  EXPECT_EQ(status_of(getting("rig.local", "https://rig.local"), rules), 0);
  EXPECT_EQ(status_of(getting("rig.local.evil.example"), rules), 421);
  EXPECT_EQ(status_of(getting("rig.local", "https://rig.local:8471"), rules), 403);
}

/// An <img> or a link of another page sends no Origin; its browser says where it comes from.
TEST(HttpGuard, TurnsAwayWhatOtherPagesFetch) {
  const auto fetched = [](const std::string& site, const std::string& mode, const std::string& path) {
    Visitor visitor = getting("localhost:8470");
    visitor.path = path, visitor.fetch_site = site, visitor.fetch_mode = mode;
    GuardRules rules = kLoopback;
    rules.open = {"GET /", "GET /viewer/{a}"};
    return status_of(visitor, rules);
  };
  for (const char* site : {"cross-site", "same-site"}) {
    EXPECT_EQ(fetched(site, "no-cors", "/api/v1/events"), 403) << site;
    EXPECT_EQ(fetched(site, "navigate", "/api/v1/rig"), 403) << site;
    EXPECT_EQ(fetched(site, "navigate", "/"), 0) << "a link to the page, " << site;
    EXPECT_EQ(fetched(site, "navigate", "/viewer/NAME"), 0) << "a place of it, " << site;
    EXPECT_EQ(fetched(site, "no-cors", "/viewer/NAME"), 403) << "not to be framed, " << site;
  }
  EXPECT_EQ(fetched("same-origin", "cors", "/api/v1/events"), 0);
  EXPECT_EQ(fetched("none", "navigate", "/api/v1/rig"), 0) << "typed into the address bar";
}

TEST(HttpGuard, LetsWhoMayOnlyLookChangeNothing) {
  GuardRules rules = kWithToken;
  rules.look_token = "only-looking-around";
  const auto asked = [&](const std::string& method, const std::string& token) {
    return status_of({method, "192.168.7.5", "", "Bearer " + token, "application/json"}, rules);
  };
  EXPECT_EQ(asked("GET", "only-looking-around"), 0);
  for (const char* change : {"POST", "PATCH", "DELETE"}) {
    EXPECT_EQ(asked(change, "only-looking-around"), 403) << change;
  }
  EXPECT_EQ(asked("POST", "correct-horse-battery"), 0);
  EXPECT_EQ(asked("GET", ""), 401);
}

TEST(HttpGuard, TakesACookieOfThisPortAndTokenWithAnOrigin) {
  GuardRules rules = kWithToken;
  rules.look_token = "only-looking-around";
  rules.port = 8470;
  const auto pair_of = [](const std::string& header) { return header.substr(0, header.find(';')); };
  const std::string host = "192.168.7.5:8470", own = "http://" + host;
  const auto asked = [&](const std::string& method, const std::string& origin, const std::string& cookie) {
    Visitor visitor = {method, host, origin, "", "application/json"};
    visitor.cookie = cookie;
    return status_of(visitor, rules);
  };
  const std::string operate = pair_of(entry_cookie(Role::kOperate, rules));
  const std::string look = pair_of(entry_cookie(Role::kLook, rules));
  EXPECT_EQ(operate.find("correct-horse"), std::string::npos);
  EXPECT_EQ(asked("GET", "", operate), 0);
  EXPECT_EQ(asked("POST", own, "other=1; " + operate), 0);
  EXPECT_EQ(asked("POST", "", operate), 403) << "no Origin: another port of this host could send it";
  EXPECT_EQ(asked("GET", own, look), 0);
  EXPECT_EQ(asked("POST", own, look), 403);
  EXPECT_EQ(asked("GET", "", "weft_8470="), 401);
  GuardRules elsewhere = rules;
  elsewhere.port = 8471;
  EXPECT_EQ(asked("GET", "", pair_of(entry_cookie(Role::kOperate, elsewhere))), 401) << "of another rig";
  GuardRules later = rules;
  later.token = "another-horse-battery";
  EXPECT_EQ(asked("GET", "", pair_of(entry_cookie(Role::kOperate, later))), 401) << "of another token";
}

TEST(HttpGuard, TakesOnlyJsonInABody) {
  const auto posted = [](const std::string& type, const char* method = "POST") {
    return status_of({method, "localhost", "", "", type}, kLoopback);
  };
  EXPECT_EQ(posted("text/plain", "PATCH"), 415);
  EXPECT_EQ(posted("", "DELETE"), 0) << "it has none, and no page elsewhere can send it unasked";
  EXPECT_EQ(posted("application/json"), 0);
  EXPECT_EQ(posted("Application/JSON ; charset=utf-8"), 0);
  for (const char* type :
       {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x",
        "text/plain; application/json", "application/jsonx"}) {
    EXPECT_EQ(posted(type), 415) << type;
  }
}

TEST(HttpGuard, TakesNoMethodThatNoCallHas) {
  for (const char* method : {"PUT", "OPTIONS", "TRACE", "CONNECT", "get"}) {
    EXPECT_EQ(status_of({method, "localhost", "", "", "application/json"}, kLoopback), 405) << method;
  }
}

class TokenFile : public testing::Test {
 protected:
  Result<std::string> read(const std::string& text, mode_t mode = 0600) const {
    std::ofstream(path_) << text;
    EXPECT_EQ(chmod(path_.c_str(), mode), 0);
    return read_token(path_);
  }
  void TearDown() override { std::filesystem::remove(path_); }
  const std::string path_ = testing::TempDir() + "weft_token_" + std::to_string(getpid());
};

TEST_F(TokenFile, IsReadWithoutWhiteSpaceAroundIt) {
  const Result<std::string> token = read("\n  0123456789abcdef\n");
  ASSERT_TRUE(token) << token.error().message();
  EXPECT_EQ(*token, "0123456789abcdef");
}

TEST_F(TokenFile, IsRefusedWhereItProtectsNothing) {
  const std::string good = "0123456789abcdef";
  for (const std::string& text :
       std::vector<std::string>{"", "   ", "short", "0123456789 abcdef", good + "\x01"}) {
    const Result<std::string> token = read(text);
    ASSERT_FALSE(token) << text;
    EXPECT_EQ(token.error().kind, ErrorKind::kBadData) << text;
  }
  const Result<std::string> open_to_others = read(good, 0644);
  ASSERT_FALSE(open_to_others);
  EXPECT_THAT(open_to_others.error().remedy, testing::HasSubstr("chmod 600"));
  std::filesystem::remove(path_);
  EXPECT_EQ(read_token(path_).error().kind, ErrorKind::kNoInput);
}

}  // namespace
}  // namespace weft::app
