// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/http_guard.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "core/files.h"

namespace weft::app {
namespace {

constexpr std::size_t kLeastTokenBytes = 16, kMostTokenBytes = 512;

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

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

bool is_our_name(const std::string& host, const std::string& listening_host) {
  const std::string name = lower(name_in(host)), ours = lower(listening_host);
  // A page's own name can be made to lead here, a bare address cannot.
  const bool on_all_addresses = ours == "0.0.0.0" || ours == "::";
  return name == "localhost" || name == ours || (on_all_addresses && is_address(name));
}

bool is_token(const std::string& authorization, const std::string& token) {
  const std::string wanted = "Bearer " + token;
  return authorization.size() == wanted.size() &&
         CRYPTO_memcmp(authorization.data(), wanted.data(), wanted.size()) == 0;
}

bool is_json(const std::string& content_type) {
  const std::string type = lower(content_type.substr(0, content_type.find(';')));
  return type.substr(0, type.find_last_not_of(" \t") + 1) == "application/json";
}

}  // namespace

std::optional<Refused> turned_away(const Visitor& visitor, const GuardRules& rules) {
  const auto refuse = [](int status, std::string what, std::string why, std::string remedy) {
    return Refused{status,
                   {ErrorKind::kUsage, std::move(what), "request", std::move(why), std::move(remedy)}};
  };
  if (visitor.method != "GET" && visitor.method != "HEAD" && visitor.method != "POST") {
    return refuse(405, "the method is not taken", visitor.method, "use GET or POST");
  }
  if (!is_our_name(visitor.host, rules.listening_host)) {
    return refuse(421, "the Host header is not this daemon's", visitor.host,
                  "ask by the address that weft serve printed, or by localhost");
  }
  if (!visitor.origin.empty() && lower(visitor.origin) != "http://" + lower(visitor.host)) {
    return refuse(403, "pages from elsewhere may not use this daemon", visitor.origin,
                  "open the daemon's own page");
  }
  if (!rules.token.empty() && !is_token(visitor.authorization, rules.token)) {
    return refuse(401, "the token is missing or wrong", "", "send 'Authorization: Bearer TOKEN'");
  }
  if (visitor.method == "POST" && !is_json(visitor.content_type)) {
    return refuse(415, "the body is not said to be JSON", visitor.content_type,
                  "send 'Content-Type: application/json'");
  }
  return std::nullopt;
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
