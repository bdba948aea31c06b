// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/scan_body.h"

namespace weft::app {
namespace {

Result<Reply> list_tags(const RigParts& parts) {
  const Result<std::vector<std::pair<std::string, int>>> tags = parts.library.tags();
  if (!tags) return tags.error();
  Json list = Json::array();
  for (const auto& [tag, sessions] : *tags) list.push_back({{"tag", tag}, {"sessions", sessions}});
  return json_reply({{"tags", std::move(list)}});
}

Result<Reply> reply_of(const Result<library::MetadataChange>& change) {
  if (!change) return change.error();
  return json_reply({{"session", change->folder.stem().string()},
                     {"before", change->before},
                     {"after", change->after},
                     {"revision", change->revision},
                     {"words", library::words_of(*change)}});
}

Result<Reply> change_session(const RigParts& parts, const Call& call) {
  Result<Json> body = parse_body(call.body);
  if (!body) return std::move(body).error();
  const Result<Session> session = parts.library.session(call.segments.at(0));
  if (!session) return session.error();
  library::Provided provided;
  if (const auto revision = body->find("revision"); revision != body->end()) {
    if (!revision->is_number_integer() || *revision < 0 || *revision > 1'000'000'000) {
      return Error{ErrorKind::kUsage, "metadata cannot be set", "revision", "must be a count",
                   "give the one that was read, or none"};
    }
    provided.revision = revision->get<int>();
    body->erase("revision");
  }
  return reply_of(parts.library.change(session->folder, *body, provided, ""));
}

Route step_back(const RigParts& parts, const char* path,
                Result<library::MetadataChange> (LibraryService::*step)()) {
  return {"POST", path, [&parts, step](const Call& call) -> Result<Reply> {
            if (const Result<Json> body = parse_body(call.body); !body) return body.error();
            return reply_of((parts.library.*step)());
          }};
}

}  // namespace

Resource library_resource(const RigParts& parts) {
  return {{{"GET", "/api/v1/library/tags", [&parts](const Call&) { return list_tags(parts); }},
           {"PATCH", "/api/v1/sessions/{name}/metadata",
            [&parts](const Call& call) { return change_session(parts, call); }},
           {"POST", "/api/v1/sessions/{name}/metadata",
            [&parts](const Call& call) { return change_session(parts, call); }},
           step_back(parts, "/api/v1/undo", &LibraryService::undo),
           step_back(parts, "/api/v1/redo", &LibraryService::redo)}};
}

}  // namespace weft::app
