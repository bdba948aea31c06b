// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "app/server/api/api.h"
#include "app/server/api/bodies/requests.h"
#include "app/server/api/bodies/scan_body.h"

namespace weft::app {
namespace {

Result<Reply> take_controls(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  if (parts.controls.renew(call.control)) {
    return json_reply({{"control", call.control},
                       {"name", parts.controls.holder()},
                       {"lease_s", Controls::kLease.count()}});
  }
  const Result<ControlRequest> wish =
      read_body<ControlRequest>(*body, {"the controls cannot be taken", "the controls", "POST control"});
  if (!wish) return wish.error();
  const Result<std::string> id = parts.controls.take(wish->name, wish->take);
  if (!id) return id.error();
  return json_reply({{"control", *id}, {"name", wish->name}, {"lease_s", Controls::kLease.count()}});
}

}  // namespace

Resource control_resource(const RigParts& parts) {
  return {{{"POST", "/api/v1/control", [&parts](const Call& call) { return take_controls(parts, call); },
            false, Pool::kQuick},
           {"DELETE", "/api/v1/control",
            [&parts](const Call& call) -> Result<Reply> {
              parts.controls.release(call.control);
              return json_reply({{"name", parts.controls.holder()}});
            },
            false, Pool::kQuick}}};
}

}  // namespace weft::app
