// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/api.h"

#include <utility>

#include "app/server/api/descriptions.h"
#include "core/files.h"

namespace weft::app {
namespace {

Json whole_description(const std::vector<Resource>& resources) {
  Json whole = Json::parse(common_description());
  for (const Resource& resource : resources) {
    const Json part = Json::parse(resource.description);
    whole["paths"].update(part["paths"]);
    whole["components"]["schemas"].update(part["schemas"]);
  }
  return whole;
}

}  // namespace

std::vector<Route> api_routes(const RigParts& parts) {
  std::vector<Resource> resources = {
      server_resource(parts),   login_resource(parts),   rig_resource(parts),    scan_resource(parts),
      sessions_resource(parts), frames_resource(parts),  jobs_resource(parts),   library_resource(parts),
      events_resource(parts),   control_resource(parts), devices_resource(parts)};
  std::vector<Route> routes;
  Reply description = json_reply(whole_description(resources));
  description.keeping = Keeping::kAskAgain;
  description.tag = sha256_of(description.body);
  routes.push_back({"GET", "/api/v1/openapi.json",
                    [description](const Call&) -> Result<Reply> { return description; }, false,
                    Pool::kQuick});
  for (Resource& resource : resources) {
    for (Route& route : resource.routes) routes.push_back(std::move(route));
  }
  return routes;
}

}  // namespace weft::app
