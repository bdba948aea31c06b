// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"
#include "app/server/api/scan_body.h"

namespace weft::app {
namespace {

Error no_query(const std::string& key, const std::string& rule) {
  return {ErrorKind::kUsage, "sessions cannot be searched so", key, rule, "see GET library in openapi.json"};
}

Result<std::int64_t> count_in(const std::string& key, const std::string& text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number > 0) return number;
  return no_query(key, "must be a number from 1");
}

Result<library::Query> query_of(const Call& call) {
  library::Query query;
  const std::array<std::pair<const char*, std::string*>, 8> texts = {{{"query", &query.words},
                                                                      {"id", &query.id},
                                                                      {"tag", &query.tag},
                                                                      {"state", &query.state},
                                                                      {"rig", &query.rig},
                                                                      {"calibration", &query.calibration},
                                                                      {"from", &query.from},
                                                                      {"before", &query.before}}};
  for (const auto& [key, value] : call.query) {
    const auto text = std::ranges::find(texts, key, [](const auto& each) { return std::string(each.first); });
    if (text != texts.end()) {
      *text->second = value;
      continue;
    }
    if (key != "limit" && key != "after") return no_query(key.substr(0, 40), "there is no such filter");
    const Result<std::int64_t> number = count_in(key, value);
    if (!number) return number.error();
    if (key == "after") query.after = *number;
    if (key == "limit") query.limit = static_cast<int>(std::min<std::int64_t>(*number, 1000));
  }
  return query;
}

Result<Reply> find_sessions(const RigParts& parts, const Call& call) {
  const Result<library::Query> query = query_of(call);
  if (!query) return query.error();
  const Result<library::Page> page = parts.library.find(*query);
  if (!page) return page.error();
  Json sessions = Json::array();
  for (const library::Entry& entry : page->entries) sessions.push_back(library::json_of(entry));
  return json_reply({{"sessions", std::move(sessions)},
                     {"total", page->total},
                     {"after", page->after ? Json(*page->after) : Json()}});
}

Result<Reply> list_tags(const RigParts& parts) {
  const Result<std::vector<std::pair<std::string, int>>> tags = parts.library.tags();
  if (!tags) return tags.error();
  Json list = Json::array();
  for (const auto& [tag, sessions] : *tags) list.push_back({{"tag", tag}, {"sessions", sessions}});
  return json_reply({{"tags", std::move(list)}});
}

Result<Reply> reply_of(const Result<library::Change>& change) {
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
  const Result<Session> session = parts.sessions.find(call.segments.at(0));
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

Route step_back(const RigParts& parts, const char* path, Result<library::Change> (LibraryService::*step)()) {
  return {"POST", path, [&parts, step](const Call& call) -> Result<Reply> {
            if (const Result<Json> body = parse_body(call.body); !body) return body.error();
            return reply_of((parts.library.*step)());
          }};
}

}  // namespace

Resource library_resource(const RigParts& parts) {
  return {{{"GET", "/api/v1/library", [&parts](const Call& call) { return find_sessions(parts, call); }},
           {"GET", "/api/v1/library/tags", [&parts](const Call&) { return list_tags(parts); }},
           {"PATCH", "/api/v1/sessions/{name}/metadata",
            [&parts](const Call& call) { return change_session(parts, call); }},
           {"POST", "/api/v1/sessions/{name}/metadata",
            [&parts](const Call& call) { return change_session(parts, call); }},
           step_back(parts, "/api/v1/undo", &LibraryService::undo),
           step_back(parts, "/api/v1/redo", &LibraryService::redo)},
          library_description()};
}

}  // namespace weft::app
