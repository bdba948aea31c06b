// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>

#include "app/server/api/api.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/http/error_reply.h"

namespace weft::app {
namespace {

constexpr int kUnauthorized = 401;

GuardRules at_port(const RigParts& parts, const Call& call) {
  GuardRules rules = parts.guard;
  rules.port = call.port;
  return rules;
}

Result<Reply> login(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  if (body->size() != 1 || !body->contains("token") || !(*body)["token"].is_string()) {
    return Error{ErrorKind::kUsage, "the body is no login", "token", "", R"(send {"token": "..."})"};
  }
  if (parts.guard.token.empty()) return json_reply({{"role", name_of(Role::kOperate)}});
  const std::optional<Role> role = role_of_token((*body)["token"].get<std::string>(), parts.guard);
  if (!role) {
    return json_reply(error_document({ErrorKind::kUsage, "the token is wrong", "token", "",
                                      "open the link that weft serve printed"}),
                      kUnauthorized);
  }
  Reply reply = json_reply({{"role", name_of(*role)}});
  reply.headers.emplace_back("Set-Cookie", entry_cookie(*role, at_port(parts, call)));
  return reply;
}

Result<Reply> logout(const RigParts& parts, const Call& call) {
  if (const Result<Json> body = parse_body(call.body); !body) return body.error();
  Reply reply = json_reply(Json::object());
  reply.headers.emplace_back("Set-Cookie", exit_cookie(at_port(parts, call)));
  return reply;
}

}  // namespace

Resource login_resource(const RigParts& parts) {
  return {{{"POST", "/api/v1/login", [&parts](const Call& call) { return login(parts, call); }, true,
            Pool::kQuick},
           {"POST", "/api/v1/logout", [&parts](const Call& call) { return logout(parts, call); }, true,
            Pool::kQuick}}};
}

}  // namespace weft::app
