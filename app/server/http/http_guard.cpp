// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/http_guard.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "app/server/http/cookies.h"
#include "app/server/http/path_pattern.h"
#include "core/base/files.h"
#include "core/base/text.h"

namespace weft::app {
namespace {

constexpr std::size_t kLeastTokenBytes = 16, kMostTokenBytes = 512;

/// The name in "name:port", "[v6]:port" or either without a port.
std::string name_in(const std::string& host) {
  if (host.starts_with('[')) return host.substr(1, host.find(']') - 1);
  return host.substr(0, host.rfind(':'));
}

bool is_address(const std::string& name) {
  std::array<unsigned char, sizeof(in6_addr)> bytes = {};
  return inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

bool is_our_name(const std::string& host, const GuardRules& rules) {
  const std::string name = small_letters(name_in(host)), ours = small_letters(rules.listening_host);
  const auto is_name = [&](const std::string& each) { return small_letters(each) == name; };
  if (std::ranges::any_of(rules.names, is_name)) return true;
  // A page's own name can be made to lead here, a bare address cannot.
  const bool on_all_addresses = ours == "0.0.0.0" || ours == "::";
  return name == "localhost" || name == ours || (on_all_addresses && is_address(name));
}

bool is_our_origin(const std::string& origin, const std::string& host, const GuardRules& rules) {
  return small_letters(origin) == "http://" + small_letters(host) ||
         std::ranges::any_of(rules.origins, [&](const std::string& each) {
           return small_letters(each) == small_letters(origin);
         });
}

/// In a time that does not tell how much of it is right.
bool is_secret(std::string_view said, std::string_view secret) {
  return !secret.empty() && said.size() == secret.size() &&
         CRYPTO_memcmp(said.data(), secret.data(), secret.size()) == 0;
}

std::string cookie_name(const GuardRules& rules) {
  return fmt::format("weft_{}", rules.port);
}

/// HMAC-SHA-256 by the role's token: whoever reads the cookie has not read the token.
std::string cookie_value(Role role, const GuardRules& rules) {
  const std::string& token = role == Role::kOperate ? rules.token : rules.look_token;
  if (token.empty()) return "";
  const std::string_view words = role == Role::kOperate ? "weft cookie: operate" : "weft cookie: look";
  std::array<unsigned char, 32> code = {};
  unsigned int bytes = 0;
  HMAC(EVP_sha256(), token.data(), static_cast<int>(token.size()),
       reinterpret_cast<const unsigned char*>(words.data()), words.size(), code.data(), &bytes);
  return fmt::format("{:02x}", fmt::join(code, ""));
}

std::string cookie_header(const GuardRules& rules, std::string_view value, int seconds) {
  return fmt::format("{}={}; Path=/; Max-Age={}; HttpOnly; SameSite=Strict", cookie_name(rules), value,
                     seconds);
}

struct Credential {
  Role role = Role::kOperate;
  bool by_cookie = false;
};

std::optional<Credential> credential_of(const Visitor& visitor, const GuardRules& rules) {
  constexpr std::string_view kBearer = "Bearer ";
  if (rules.token.empty()) return Credential{};
  if (!visitor.authorization.empty()) {
    const std::string_view said = visitor.authorization;
    const auto role =
        said.starts_with(kBearer) ? role_of_token(said.substr(kBearer.size()), rules) : std::nullopt;
    if (!role) return std::nullopt;
    return Credential{*role};
  }
  const std::string_view cookie = cookie_in(visitor.cookie, cookie_name(rules));
  for (const Role role : {Role::kOperate, Role::kLook}) {
    if (is_secret(cookie, cookie_value(role, rules))) return Credential{role, true};
  }
  return std::nullopt;
}

bool is_open(const Visitor& visitor, const GuardRules& rules) {
  const std::string call = visitor.method + " " + visitor.path;
  return std::ranges::any_of(
      rules.open, [&](const std::string& pattern) { return segments_in(pattern, call).has_value(); });
}

/// What a browser fetches for a page of another site or port. Who follows a link to the page itself may.
bool is_fetched_from_elsewhere(const Visitor& visitor, const GuardRules& rules) {
  const bool elsewhere = visitor.fetch_site == "cross-site" || visitor.fetch_site == "same-site";
  const bool to_the_page =
      visitor.method == "GET" && visitor.fetch_mode == "navigate" && is_open(visitor, rules);
  return elsewhere && !to_the_page;
}

bool is_json(const std::string& content_type) {
  const std::string type = small_letters(content_type.substr(0, content_type.find(';')));
  return type.substr(0, type.find_last_not_of(" \t") + 1) == "application/json";
}

}  // namespace

std::optional<Refused> turned_away(const Visitor& visitor, const GuardRules& rules) {
  const auto refuse = [](int status, std::string what, std::string why, std::string remedy) {
    return Refused{status,
                   {ErrorKind::kUsage, std::move(what), "request", std::move(why), std::move(remedy)}};
  };
  const bool is_change = visitor.method == "POST" || visitor.method == "PATCH" || visitor.method == "DELETE";
  if (visitor.method != "GET" && visitor.method != "HEAD" && !is_change) {
    return refuse(405, "the method is not taken", visitor.method, "use GET, POST, PATCH or DELETE");
  }
  if (!is_our_name(visitor.host, rules)) {
    return refuse(421, "the Host header is not this daemon's", visitor.host,
                  "ask by the address that weft serve printed, by localhost, or by one of daemon.names");
  }
  const bool from_elsewhere = !visitor.origin.empty() && !is_our_origin(visitor.origin, visitor.host, rules);
  if (from_elsewhere || is_fetched_from_elsewhere(visitor, rules)) {
    return refuse(403, "pages from elsewhere may not use this daemon",
                  from_elsewhere ? visitor.origin : visitor.fetch_site,
                  "open the daemon's own page; a proxy's origin goes into daemon.origins of the rig file");
  }
  if (!is_open(visitor, rules)) {
    const auto credential = credential_of(visitor, rules);
    if (!credential) {
      return refuse(401, "the token is missing or wrong", "",
                    "send 'Authorization: Bearer TOKEN', or open the link that weft serve printed");
    }
    if (is_change && credential->by_cookie && visitor.origin.empty()) {
      return refuse(403, "a change by a cookie needs an Origin", "", "open the daemon's own page");
    }
    if (is_change && credential->role == Role::kLook) {
      return refuse(403, "this token may only look", visitor.path, "come in with the token of daemon.token");
    }
  }
  if (is_change && visitor.method != "DELETE" && !is_json(visitor.content_type)) {
    return refuse(415, "the body is not said to be JSON", visitor.content_type,
                  "send 'Content-Type: application/json'");
  }
  return std::nullopt;
}

const char* name_of(Role role) {
  return role == Role::kLook ? "look" : "operate";
}

std::optional<Role> role_of_token(std::string_view token, const GuardRules& rules) {
  if (is_secret(token, rules.token)) return Role::kOperate;
  if (is_secret(token, rules.look_token)) return Role::kLook;
  return std::nullopt;
}

std::string entry_cookie(Role role, const GuardRules& rules) {
  constexpr int kMonthS = 30 * 24 * 3600;
  return cookie_header(rules, cookie_value(role, rules), kMonthS);
}

std::string exit_cookie(const GuardRules& rules) {
  return cookie_header(rules, "", 0);
}

Result<std::string> new_token() {
  std::array<unsigned char, 32> bytes = {};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
    return Error{ErrorKind::kTryAgain, "no token can be made", "", "the system gives no random numbers",
                 "try again"};
  }
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

Result<std::string> read_token(const std::string& file) {
  Result<std::string> text = read_text(file, 4096);
  if (!text) return std::move(text).error();
  const auto refuse = [&](std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, "the token cannot be used", file, std::move(why), std::move(remedy)};
  };
  struct stat about = {};
  if (stat(file.c_str(), &about) != 0 || (about.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return refuse("others may read the file", fmt::format("run 'chmod 600 {}'", file));
  }
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto begin = std::ranges::find_if_not(*text, is_space);
  const auto end = std::find_if_not(text->rbegin(), std::make_reverse_iterator(begin), is_space).base();
  const std::string token(begin, end);
  const bool printable = std::ranges::all_of(token, [](char c) { return c > ' ' && c < 0x7f; });
  if (token.size() < kLeastTokenBytes || token.size() > kMostTokenBytes || !printable) {
    return refuse(fmt::format("it has {} characters; {} to {} that can be printed are needed", token.size(),
                              kLeastTokenBytes, kMostTokenBytes),
                  fmt::format("run 'openssl rand -hex 32 > {}'", file));
  }
  return token;
}

}  // namespace weft::app
