// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"

namespace weft::app {

Resource server_resource() {
  return {{{"GET", "/api/v1/healthz",
            [](const Call&) -> Result<Reply> {
              return json_reply({{"status", "ok"}});
            },
            false, Pool::kAtOnce}},
          server_description()};
}

}  // namespace weft::app
