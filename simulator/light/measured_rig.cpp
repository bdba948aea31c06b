// SPDX-License-Identifier: Apache-2.0
#include "simulator/light/measured_rig.h"

#include <fmt/format.h>

#include "core/base/files.h"
#include "core/base/json_document.h"

namespace weft::simulator {
namespace {

constexpr std::size_t kMostLeds = 256;
constexpr int kMostDepth = 16;
constexpr double kShortestAim = 1e-6;

Error not_a_rig(const std::filesystem::path& file, std::string why) {
  return {ErrorKind::kBadData, "this is no measured rig", file.string(), std::move(why),
          "give lights.json of a calibration, or LEDs with position_mm, direction, mu and flux_rgb"};
}

Result<Json> document_of(const std::filesystem::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  bool too_deep = false;
  const auto shallow = [&](int depth, Json::parse_event_t, const Json&) {
    too_deep = too_deep || depth > kMostDepth;
    return !too_deep;
  };
  Json document = Json::parse(*text, shallow, /*allow_exceptions=*/false);
  if (too_deep) return not_a_rig(file, fmt::format("it is nested over {} deep", kMostDepth));
  if (!document.is_object()) return not_a_rig(file, "it is not an object of JSON");
  if (document.contains("schema")) return read_json(file, "weft.lights", 1);
  return document;
}

}  // namespace

Result<std::vector<NearLight>> read_measured_rig(const std::filesystem::path& file,
                                                 double camera_distance_mm) {
  const Result<Json> document = document_of(file);
  if (!document) return document.error();
  const bool in_rig_frame = document->contains("schema");
  JsonFields fields(*document, file.string());
  if (in_rig_frame && fields.text("kind") != "near") fields.reject("kind", "must be \"near\"");
  const Json& list = fields.list("leds");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  if (list.empty() || list.size() > kMostLeds)
    return not_a_rig(file, fmt::format("it has {} LEDs, not 1 to {}", list.size(), kMostLeds));

  std::vector<NearLight> leds;
  for (const Json& entry : list) {
    JsonFields led_fields(entry, fmt::format("{}: LED {}", file.string(), leds.size() + 1));
    const char* aim = in_rig_frame ? "aim" : "direction";
    NearLight& led = leds.emplace_back();
    led.position_mm = led_fields.vec3("position_mm");
    led.aim = led_fields.vec3(aim);
    led.mu = led_fields.number("mu");
    led.flux_rgb = led_fields.rgb("flux_rgb");
    if (!(length(led.aim) > kShortestAim)) led_fields.reject(aim, "must be longer than 0");
    if (led.mu < 0) led_fields.reject("mu", "must not be negative");
    for (const double flux : led.flux_rgb) {
      if (flux <= 0) led_fields.reject("flux_rgb", "must be above 0 in every channel");
    }
    if (Result<void> ok = led_fields.status(); !ok) return std::move(ok).error();
    if (!in_rig_frame) {
      led.position_mm = {led.position_mm.x, -led.position_mm.y, camera_distance_mm - led.position_mm.z};
      led.aim = {led.aim.x, -led.aim.y, -led.aim.z};
    }
    led.aim = normalized(led.aim);
  }
  return leds;
}

}  // namespace weft::simulator
