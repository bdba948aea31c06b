// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"
#include "core/files.h"

namespace weft::app {
namespace {

constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

Route page_file(const char* path, const char* type, const char* text) {
  const Reply reply = {200,
                       type,
                       text,
                       {{"Content-Security-Policy", kPolicy},
                        {"Referrer-Policy", "no-referrer"},
                        {"Cross-Origin-Opener-Policy", "same-origin"}},
                       Keeping::kAskAgain,
                       sha256_of(text)};
  return {"GET", path, [reply](const Call&) -> Result<Reply> { return reply; }, true, Pool::kQuick};
}

}  // namespace

std::vector<Route> page_routes() {
  return {page_file("/", "text/html; charset=utf-8", index_text()),
          page_file("/enter.js", "text/javascript; charset=utf-8", enter_text())};
}

}  // namespace weft::app
