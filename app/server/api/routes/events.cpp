// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "app/server/api/api.h"

namespace weft::app {

Resource events_resource(const RigParts& parts) {
  Route stream = {"GET", "/api/v1/events", {}, false, Pool::kStreams};
  stream.follows = [&parts](const Call& call) {
    parts.controls.renew(call.control);
    if (const auto screen = call.query.find("screen"); screen != call.query.end() && screen->second == "1")
      parts.screens.follow();
  };
  return {{std::move(stream)}};
}

}  // namespace weft::app
