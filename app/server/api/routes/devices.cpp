// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <string>
#include <vector>

#include "app/server/api/api.h"
#include "app/server/api/bodies/requests.h"
#include "app/server/api/routes/frame_tile.h"

namespace weft::app {
namespace {

BodyWords words_of(const char* subject, const char* call) {
  return {"the devices cannot be asked for this", subject, call};
}

Json devices_of(const RigParts& parts) {
  Json document = to_json(parts.attendance.status());
  document.update(to_json(parts.keeper.status(), parts.rig)["devices"]);
  return document;
}

Result<Reply> open_or_close(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Result<DevicesRequest> wish =
      read_body<DevicesRequest>(*body, words_of("the devices", "POST rig/devices"));
  if (!wish) return wish.error();
  if (Result<void> done = wish->open ? parts.attendance.open() : parts.attendance.close(); !done)
    return std::move(done).error();
  return json_reply(devices_of(parts));
}

Result<Reply> lit_reply(const Result<Attendance::Lit>& lit) {
  if (!lit) return lit.error();
  const double lease_s = 1e-3 * static_cast<double>(Attendance::kLightLease.count());
  return json_reply({{"lit", lit->leds}, {"rest_s", lit->rest_s}, {"lease_s", lease_s}});
}

Result<Reply> light(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  LightRequest any;
  any.most_leds = parts.rig.leds;
  const Result<LightRequest> wish = read_body(*body, words_of("a light", "POST rig/light"), any);
  if (!wish) return wish.error();
  return lit_reply(wish->round ? parts.attendance.light_in_turns() : parts.attendance.light(wish->leds));
}

Result<Reply> begin_shot(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  TestShotRequest any;
  any.most_leds = parts.rig.leds;
  const Result<TestShotRequest> wish = read_body(*body, words_of("a test shot", "POST rig/test-shot"), any);
  if (!wish) return wish.error();
  const Result<int> id = parts.attendance.shoot(wish->led, wish->exposure_us);
  if (!id) return id.error();
  return json_reply({{"id", *id}}, kAccepted);
}

Result<TestShot> shot_in(const RigParts& parts, const Call& call) {
  const std::string& text = call.segments.at(0);
  int id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  return parts.attendance.shot(error == std::errc() && end == text.data() + text.size() ? id : 0);
}

Result<Reply> one_shot(const RigParts& parts, const Call& call) {
  const Result<TestShot> shot = shot_in(parts, call);
  if (!shot) return shot.error();
  return json_reply(document_of(*shot, parts.pictures));
}

Result<FrameFile> frame_of_shot(const RigParts& parts, const Call& call) {
  const Result<TestShot> shot = shot_in(parts, call);
  if (!shot) return shot.error();
  if (shot->frame) return *shot->frame;
  return Error{ErrorKind::kNoInput, "the test shot has no picture", call.segments.at(0),
               shot->error ? "it failed" : "it is being taken", "ask again, or take another one"};
}

Result<Reply> picture(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = frame_of_shot(parts, call);
  if (!frame) return frame.error();
  Result<std::string> png = parts.pictures.thumbnail(*frame);
  if (!png) return std::move(png).error();
  Reply reply;
  reply.type = "image/png";
  reply.body = std::move(*png);
  reply.tag = frame->sha256;
  return reply;
}

Result<Reply> shot_tile(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = frame_of_shot(parts, call);
  if (!frame) return frame.error();
  return tile_of_frame(parts, *frame, call.segments.at(1), call.segments.at(2), call);
}

/// The finder's next picture after the one that the call names.
Result<Attendance::Look> next_look(const RigParts& parts, const Call& call) {
  std::int64_t after = 0;
  if (const auto found = call.query.find("after"); found != call.query.end()) {
    const std::string& text = found->second;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), after);
    if (error != std::errc() || end != text.data() + text.size() || after < 0)
      return Error{ErrorKind::kUsage, "there is no such picture", "after",
                   "must be the number of one, from 0", "see GET rig/live/frame in openapi.json"};
  }
  return parts.attendance.look(after);
}

Result<Reply> live_framing(const RigParts& parts, const Call& call) {
  const Result<Attendance::Look> look = next_look(parts, call);
  if (!look) return look.error();
  Result<Json> seen = parts.framing.seen(look->jpeg, parts.sets.aim());
  if (!seen) return std::move(seen).error();
  (*seen)["frame"] = look->number;
  return json_reply(*seen);
}

Result<Reply> live_frame(const RigParts& parts, const Call& call) {
  Result<Attendance::Look> look = next_look(parts, call);
  if (!look) return std::move(look).error();
  Reply reply;
  reply.type = "image/jpeg";
  reply.body = std::move(look->jpeg);
  reply.headers.emplace_back("X-Weft-Frame", std::to_string(look->number));
  return reply;
}

}  // namespace

Resource devices_resource(const RigParts& parts) {
  const auto call = [&parts](const char* method, const char* path, auto handle, Pool pool) {
    return Route{method, path, [&parts, handle](const Call& asked) { return handle(parts, asked); }, false,
                 pool};
  };
  return {{call(
               "GET", "/api/v1/rig/devices",
               [](const RigParts& all, const Call&) -> Result<Reply> { return json_reply(devices_of(all)); },
               Pool::kQuick),
           call("POST", "/api/v1/rig/devices", open_or_close, Pool::kDevices),
           call("POST", "/api/v1/rig/light", light, Pool::kDevices),
           call("POST", "/api/v1/rig/test-shot", begin_shot, Pool::kDevices),
           call("GET", "/api/v1/rig/live/frame", live_frame, Pool::kDevices),
           call("GET", "/api/v1/rig/live/framing", live_framing, Pool::kDevices),
           call(
               "GET", "/api/v1/rig/framing",
               [](const RigParts& all, const Call&) -> Result<Reply> {
                 const Result<Json> known = all.framing.known();
                 return known ? json_reply(*known) : Result<Reply>(known.error());
               },
               Pool::kDisk),
           call("GET", "/api/v1/rig/test-shots/{id}", one_shot, Pool::kPictures),
           call("GET", "/api/v1/rig/test-shots/{id}/picture", picture, Pool::kPictures),
           call("GET", "/api/v1/rig/test-shots/{id}/tiles/{level}/{tile}", shot_tile, Pool::kTiles)}};
}

}  // namespace weft::app
