// SPDX-License-Identifier: Apache-2.0
#include "app/server/page/served_page.h"

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/sha256.h"

namespace weft::app {
namespace {

// No other page may frame this one, and nothing but this server is asked for anything.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
    "'self'; "
    "worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
    "require-trusted-types-for 'script'";

constexpr std::array<std::pair<std::string_view, const char*>, 7> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".woff2", "font/woff2"},
}};

const char* type_of(std::string_view path) {
  for (const auto& [ending, type] : kTypes) {
    if (path.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

// The first words of the addresses that the page itself takes apart.
constexpr std::array<const char*, 10> kScreens = {"desk",      "library", "sessions", "viewer", "material",
                                                  "calibrate", "batches", "jobs",     "doctor", "tour"};
constexpr std::array<const char*, 2> kSetsOfMaps = {"/viewer/{session}/maps/{id}",
                                                    "/material/{of}/{is}/{id}"};
constexpr const char* kIndex = "/index.html";

std::vector<std::string> addresses_of(std::string_view path) {
  if (path != kIndex) return {std::string(path)};
  std::vector<std::string> addresses = {"/"};
  addresses.insert(addresses.end(), kSetsOfMaps.begin(), kSetsOfMaps.end());
  for (const char* screen : kScreens) {
    for (const char* further : {"", "/{a}", "/{a}/{b}"}) {
      addresses.push_back(std::string("/") + screen + further);
    }
  }
  return addresses;
}

/// As it is, and packed for who takes that.
using Replies = std::pair<Reply, Reply>;

Replies replies_of(const PageFile& file) {
  Reply plain = {200,
                 type_of(file.path),
                 std::string(file.bytes),
                 {{"Content-Security-Policy", kPolicy},
                  {"Referrer-Policy", "no-referrer"},
                  {"Cross-Origin-Opener-Policy", "same-origin"},
                  {"Vary", "Accept-Encoding"}}};
  plain.keeping = file.path.starts_with("/assets/") ? Keeping::kForever : Keeping::kAskAgain;
  plain.tag = sha256_of(plain.body);
  Reply packed = plain;
  if (file.gzipped.size() < file.bytes.size()) {
    packed.body = file.gzipped;
    packed.tag += "-gzip";
    packed.headers.emplace_back("Content-Encoding", "gzip");
  }
  return {std::move(plain), std::move(packed)};
}

}  // namespace

std::vector<Route> page_routes(const std::vector<PageFile>& files) {
  std::vector<Route> routes;
  for (const PageFile& file : files) {
    const auto replies = std::make_shared<const Replies>(replies_of(file));
    const auto handle = [replies](const Call& call) -> Result<Reply> {
      return call.takes_gzip ? replies->second : replies->first;
    };
    for (std::string& address : addresses_of(file.path)) {
      routes.push_back({"GET", std::move(address), handle, true, Pool::kQuick});
    }
  }
  return routes;
}

}  // namespace weft::app
