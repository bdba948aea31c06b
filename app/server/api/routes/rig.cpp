// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/routes/session_choice.h"

namespace weft::app {
namespace {

constexpr int kMostResumable = 100;

Result<Reply> whole_status(const RigParts& parts) {
  Json status = to_json(parts.keeper.status(), parts.rig);
  const std::string session = parts.keeper.session();
  library::Query query = unfinished_of(parts.rig);
  query.limit = kMostResumable;
  const Result<library::CataloguePage> unfinished = parts.library.find(query);
  if (!unfinished) return unfinished.error();
  Json resumable = Json::array();
  for (const library::Entry& each : unfinished->entries) {
    if (each.name != session) resumable.push_back(each.name);
  }
  status["resumable"] = std::move(resumable);
  status["virtual"] = !parts.rig.daemon.virtual_control.empty();
  status["lock"] = {{"pid", getpid()}, {"folder", parts.state.string()}};
  return json_reply(status);
}

}  // namespace

Resource rig_resource(const RigParts& parts) {
  return {{{"GET", "/api/v1/rig", [&parts](const Call&) { return whole_status(parts); }}}};
}

}  // namespace weft::app
