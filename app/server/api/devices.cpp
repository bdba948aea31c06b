// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <string>
#include <vector>

#include "app/server/api/api.h"
#include "app/server/api/frame_tile.h"
#include "app/server/api/scan_body.h"

namespace weft::app {
namespace {

constexpr double kLongestShot_us = 30e6;

Error refused(const char* field, std::string rule) {
  return {ErrorKind::kUsage, "the devices cannot be asked for this", field, std::move(rule),
          "see rig/devices, rig/light and rig/test-shot in openapi.json"};
}

Result<int> led_of(const Json& value, const RigParts& parts, int least) {
  const bool is_there = value.is_number_integer() && value >= least && value <= parts.rig.leds;
  if (is_there) return value.get<int>();
  return refused("led", fmt::format("must be {} to {}", least, parts.rig.leds));
}

Json devices_of(const RigParts& parts) {
  Json document = to_json(parts.attendance.status());
  document.update(to_json(parts.keeper.status(), parts.rig)["devices"]);
  return document;
}

Result<Reply> open_or_close(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Json open = body->value("open", Json());
  if (!open.is_boolean()) return refused("open", "must be true or false");
  if (Result<void> done = open.get<bool>() ? parts.attendance.open() : parts.attendance.close(); !done)
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
  const Json round = body->value("round", Json(false));
  if (!round.is_boolean()) return refused("round", "must be true or false");
  if (round.get<bool>()) {
    if (body->contains("leds")) return refused("leds", "must be absent where LEDs take turns");
    return lit_reply(parts.attendance.light_in_turns());
  }
  const Json list = body->value("leds", Json());
  if (!list.is_array() || list.size() > 2) return refused("leds", "must be a list of no LED, one or two");
  std::vector<int> leds;
  for (const Json& each : list) {
    const Result<int> led = led_of(each, parts, 1);
    if (!led) return led.error();
    leds.push_back(*led);
  }
  if (leds.size() == 2 && leds[0] == leds[1]) return refused("leds", "must be two different ones");
  return lit_reply(parts.attendance.light(leds));
}

Result<Reply> begin_shot(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Result<int> led = led_of(body->value("led", Json()), parts, 0);
  if (!led) return led.error();
  const Json exposure = body->value("exposure_us", Json());
  if (!exposure.is_number() || !(exposure > 0) || exposure > kLongestShot_us)
    return refused("exposure_us", fmt::format("must be above 0 and at most {:.0f}", kLongestShot_us));
  const Result<int> id = parts.attendance.shoot(*led, exposure.get<double>());
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
      return refused("after", "must be the number of a picture, from 0");
  }
  return parts.attendance.look(after);
}

Result<Reply> live_framing(const RigParts& parts, const Call& call) {
  const Result<Attendance::Look> look = next_look(parts, call);
  if (!look) return look.error();
  Result<Json> seen = parts.framing.seen(look->jpeg, parts.sets.board());
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
