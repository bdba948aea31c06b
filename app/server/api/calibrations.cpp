// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"
#include "app/server/api/scan_body.h"

namespace weft::app {
namespace {

Error refused_set(const char* field, std::string rule) {
  return {ErrorKind::kUsage, "the set cannot be worked on", field, std::move(rule),
          "see calibrations/work in openapi.json"};
}

Result<Reply> replied(Result<Json> document, int status = 200) {
  if (!document) return std::move(document).error();
  return json_reply(*document, status);
}

Result<Reply> begin_or_go_on(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  for (const char* key : {"part", "name", "description", "from"}) {
    if (const auto found = body->find(key); found != body->end() && !found->is_string())
      return refused_set(key, "must be a text");
  }
  const std::optional<SetPart> part = set_part_of(body->value("part", ""));
  if (!part) return refused_set("part", fmt::format("must be one of {}", fmt::join(set_part_names(), ", ")));
  SetKeeper::Wish wish;
  wish.part = *part;
  wish.name = body->value("name", "");
  wish.description = body->value("description", "");
  wish.from = body->value("from", "");
  return replied(parts.sets.begin(wish));
}

Result<Reply> photograph_next(const RigParts& parts, const Call& call) {
  if (const Result<Json> body = parse_body(call.body); !body) return body.error();
  const Result<std::string> by = parts.controls.commander(call.control);
  if (!by) return by.error();
  return replied(parts.sets.photograph(*by), kAccepted);
}

Result<Reply> leave_out_or_take_back(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Json name = body->value("name", Json()), out = body->value("out", Json(true));
  if (!name.is_string()) return refused_set("name", "must be the name of a photograph");
  if (!out.is_boolean()) return refused_set("out", "must be true or false");
  return replied(parts.sets.leave_out(name.get<std::string>(), out.get<bool>()));
}

}  // namespace

Resource calibrations_resource(const RigParts& parts) {
  const auto call = [&parts](const char* method, const char* path, auto handle, Pool pool) {
    return Route{method, path, [&parts, handle](const Call& asked) { return handle(parts, asked); }, false,
                 pool};
  };
  return {{call("POST", "/api/v1/calibrations/work", begin_or_go_on, Pool::kDevices),
           call(
               "GET", "/api/v1/calibrations/work",
               [](const RigParts& all, const Call&) { return replied(all.sets.document()); }, Pool::kQuick),
           call("POST", "/api/v1/calibrations/work/photograph", photograph_next, Pool::kQuick),
           call("POST", "/api/v1/calibrations/work/leave-out", leave_out_or_take_back, Pool::kDevices)},
          calibrations_description()};
}

}  // namespace weft::app
