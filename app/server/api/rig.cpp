// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"

namespace weft::app {
namespace {

Result<Reply> whole_status(const RigParts& parts) {
  Json status = to_json(parts.keeper.status(), parts.rig);
  const std::string session = parts.keeper.session();
  Json resumable = Json::array();
  for (const Json& name : parts.sessions.resumable()) {
    if (name != session) resumable.push_back(name);
  }
  status["resumable"] = std::move(resumable);
  status["lock"] = {{"pid", getpid()}, {"folder", parts.state.string()}};
  return json_reply(status);
}

}  // namespace

Resource rig_resource(const RigParts& parts) {
  return {{{"GET", "/api/v1/rig", [&parts](const Call&) { return whole_status(parts); }}}, rig_description()};
}

}  // namespace weft::app
