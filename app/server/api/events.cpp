// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"

namespace weft::app {

Resource events_resource() {
  return {{{"GET", "/api/v1/events", {}, false, Pool::kStreams}}, events_description()};
}

}  // namespace weft::app
