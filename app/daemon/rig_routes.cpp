// SPDX-License-Identifier: Apache-2.0
#include "app/daemon/rig_routes.h"

#include <unistd.h>

#include <chrono>
#include <utility>

#include "app/daemon/error_json.h"
#include "app/daemon/scan_body.h"
#include "app/daemon/session_choice.h"
#include "app/daemon/session_name.h"
#include "core/files.h"

namespace weft::app {
namespace {

constexpr int kAccepted = 202, kBusy = 503;

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

Result<Reply> start_scan(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  Result<SessionChoice> choice = choose_session(*body, parts.rig, std::chrono::system_clock::now());
  if (!choice) return std::move(choice).error();
  if (Result<void> made = make_writable_folder(parts.rig.scan.sessions); !made)
    return std::move(made).error();
  if (Result<void> begun = parts.keeper.begin(std::move(choice->request)); !begun)
    return std::move(begun).error();
  return json_reply(to_json(*choice), kAccepted);
}

/// A step whose success is told by the status it leads to.
template <typename Step>
Result<Reply> after(const RigParts& parts, const Call& call, const Step& step) {
  if (const Result<Json> body = parse_body(call.body); !body) return body.error();
  if (Result<void> done = step(); !done) return std::move(done).error();
  return json_reply(to_json(parts.keeper.status(), parts.rig), kAccepted);
}

/// Too many pictures at once is this server's fault, not a conflict with the rig's state.
Result<Reply> busy_or(const Error& error) {
  if (error.kind == ErrorKind::kTryAgain) return json_reply(error_document(error), kBusy);
  return error;
}

Result<Reply> thumbnail(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = parts.sessions.frame(call.segments.at(0), call.segments.at(1));
  if (!frame) return frame.error();
  Result<std::string> png = parts.pictures.thumbnail(*frame);
  if (!png) return busy_or(png.error());
  return Reply{200, "image/png", std::move(*png)};
}

Result<Reply> histogram(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = parts.sessions.frame(call.segments.at(0), call.segments.at(1));
  if (!frame) return frame.error();
  const Result<Json> histogram = parts.pictures.histogram(*frame);
  if (!histogram) return busy_or(histogram.error());
  return json_reply(*histogram);
}

Result<Reply> next_name(const RigParts& parts, const Call& call) {
  const auto fabric = call.query.find("fabric");
  const Result<std::string> name =
      next_session_name(parts.rig.scan.session_name, fabric == call.query.end() ? "cloth" : fabric->second,
                        parts.rig.name, parts.rig.scan.sessions, std::chrono::system_clock::now());
  if (!name) return name.error();
  return json_reply({{"session", *name}, {"folder", (parts.rig.scan.sessions / (*name + ".weft")).string()}});
}

}  // namespace

std::vector<Route> rig_routes(const RigParts& parts) {
  const auto answering = [&parts](auto answer) {
    return [&parts, answer](const Call& call) -> Result<Reply> { return answer(parts, call); };
  };
  return {
      {"GET", "/api/v1/healthz",
       [](const Call&) -> Result<Reply> {
         return json_reply({{"status", "ok"}});
       }},
      {"GET", "/api/v1/openapi.json",
       [](const Call&) -> Result<Reply> {
         return Reply{200, "application/json", openapi_text()};
       }},
      {"GET", "/api/v1/rig", [&parts](const Call&) { return whole_status(parts); }},
      {"POST", "/api/v1/scan", answering(start_scan)},
      {"POST", "/api/v1/scan/pause",
       [&parts](const Call& call) { return after(parts, call, [&] { return parts.keeper.pause(); }); }},
      {"POST", "/api/v1/scan/resume",
       [&parts](const Call& call) { return after(parts, call, [&] { return parts.keeper.resume(); }); }},
      {"POST", "/api/v1/scan/cancel",
       [&parts](const Call& call) { return after(parts, call, [&] { return parts.keeper.cancel(); }); }},
      {"GET", "/api/v1/sessions",
       [&parts](const Call&) -> Result<Reply> {
         return json_reply({{"sessions", parts.sessions.list()}});
       }},
      {"GET", "/api/v1/sessions/{name}",
       [&parts](const Call& call) -> Result<Reply> {
         const Result<Json> session = parts.sessions.describe(call.segments.at(0));
         if (!session) return session.error();
         return json_reply(*session);
       }},
      {"GET", "/api/v1/sessions/{name}/frames/{index}/thumbnail", answering(thumbnail)},
      {"GET", "/api/v1/sessions/{name}/frames/{index}/histogram", answering(histogram)},
      {"GET", "/api/v1/next-name", answering(next_name)},
      {"GET", "/api/v1/events", {}},
  };
}

}  // namespace weft::app
