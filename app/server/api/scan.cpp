// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <string>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"
#include "app/server/api/scan_body.h"
#include "app/server/api/session_choice.h"
#include "core/files.h"

namespace weft::app {
namespace {

Result<Reply> start_scan(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  const Result<std::string> by = parts.controls.commander(call.control);
  if (!by) return by.error();
  Result<SessionChoice> choice =
      choose_session(*body, parts.rig, parts.library, std::chrono::system_clock::now());
  if (!choice) return std::move(choice).error();
  if (const auto dry = body->find("dry_run"); dry != body->end() && *dry == true)
    return json_reply(to_json(*choice));
  if (Result<void> made = make_writable_folder(parts.rig.scan.sessions); !made)
    return std::move(made).error();
  const std::filesystem::path folder = choice->request.session;
  if (Result<void> begun = parts.keeper.begin(std::move(choice->request), *by); !begun)
    return std::move(begun).error();
  parts.library.watch(folder);
  return json_reply(to_json(*choice), kAccepted);
}

/// A step whose success is told by the status it leads to; it hears who commands it.
template <typename Step>
Result<Reply> after(const RigParts& parts, const Call& call, const Step& step) {
  if (const Result<Json> body = parse_body(call.body); !body) return body.error();
  const Result<std::string> by = parts.controls.commander(call.control);
  if (!by) return by.error();
  if (Result<void> done = step(*by); !done) return std::move(done).error();
  return json_reply(to_json(parts.keeper.status(), parts.rig), kAccepted);
}

}  // namespace

Resource scan_resource(const RigParts& parts) {
  return {{{"POST", "/api/v1/scan", [&parts](const Call& call) { return start_scan(parts, call); }},
           {"POST", "/api/v1/scan/pause",
            [&parts](const Call& call) {
              return after(parts, call, [&](const std::string&) { return parts.keeper.pause(); });
            },
            false, Pool::kQuick},
           {"POST", "/api/v1/scan/resume",
            [&parts](const Call& call) {
              return after(parts, call, [&](const std::string& by) { return parts.keeper.resume(by); });
            },
            false, Pool::kQuick},
           {"POST", "/api/v1/scan/cancel",
            [&parts](const Call& call) {
              return after(parts, call, [&](const std::string&) { return parts.keeper.cancel(); });
            },
            false, Pool::kQuick}},
          scan_description()};
}

}  // namespace weft::app
