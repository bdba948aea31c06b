// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/rig_status.h"

#include <utility>

#include "core/describe/error_json.h"

namespace weft::app {
namespace {

const char* word_of(RigStatus::State state) {
  switch (state) {
    case RigStatus::State::kIdle:
      return "idle";
    case RigStatus::State::kAttended:
      return "attended";
    case RigStatus::State::kConnecting:
      return "connecting";
    case RigStatus::State::kScanning:
      return "scanning";
    case RigStatus::State::kPaused:
      return "paused";
    case RigStatus::State::kFailed:
      return "failed";
  }
  return "failed";
}

const char* word_of(LedStatus::State state) {
  switch (state) {
    case LedStatus::State::kWaiting:
      return "waiting";
    case LedStatus::State::kExposing:
      return "exposing";
    case LedStatus::State::kChecking:
      return "checking";
    case LedStatus::State::kKept:
      return "kept";
    case LedStatus::State::kRefused:
      return "refused";
  }
  return "waiting";
}

Json to_json(const LedStatus& led) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"led", led.led},
          {"state", word_of(led.state)},
          {"takes", led.takes},
          {"code", led.finding.code},
          {"level", number(led.finding.level)},
          {"misfit", number(led.finding.misfit)},
          {"clipped", led.clipped}};
}

// What may be asked of the rig now.
std::vector<const char*> commands_of(const RigStatus& status, const capture::Rig& rig) {
  using State = RigStatus::State;
  if (rig.leds == 0) return {};
  std::vector<const char*> commands;
  const bool is_free =
      status.state == State::kIdle || status.state == State::kAttended || status.state == State::kFailed;
  if (is_free) {
    commands = {"scan", "devices"};
    if (status.can_go_on) commands.push_back("resume");
    if (status.state == State::kAttended) commands.insert(commands.end(), {"light", "test-shot"});
    return commands;
  }
  if (status.state == State::kPaused) commands.push_back("resume");
  if (status.state == State::kScanning && status.scan.phase != capture::ScanPhase::kFinishing)
    commands.push_back("pause");
  commands.push_back("cancel");
  return commands;
}

Json to_json(const capture::CameraFacts& facts) {
  return {{"model", facts.model},
          {"serial", facts.serial},
          {"port", facts.port},
          {"exposure_us", facts.exposure.exposure_us},
          {"iso", facts.exposure.iso},
          {"f_number", facts.exposure.f_number},
          {"battery", facts.battery},
          {"clock_offset_s", facts.clock_offset_s},
          {"clock_uncertainty_s", facts.clock_uncertainty_s}};
}

}  // namespace

Json to_json(const RigStatus& status, const capture::Rig& rig) {
  const Json nothing;
  const bool has_session = !status.session.empty();
  Json leds = Json::array();
  for (const LedStatus& led : status.leds) leds.push_back(to_json(led));
  return {{"rig", rig.name},
          {"state", word_of(status.state)},
          {"phase", has_session ? Json(capture::name_of(status.scan.phase)) : nothing},
          {"session", has_session ? Json(status.session) : nothing},
          {"led", status.scan.led},
          {"role", name_of(status.scan.role)},
          {"polariser", name_of(status.scan.polariser)},
          {"frames", status.scan.frames},
          {"frames_planned", status.scan.frames_planned},
          {"exposure_us", status.scan.exposure_us},
          {"why", status.scan.why},
          {"error", status.error ? json_of(*status.error) : nothing},
          {"warnings", status.warnings},
          {"leds", std::move(leds)},
          {"left_s", status.left_s ? Json(*status.left_s) : nothing},
          {"can", commands_of(status, rig)},
          {"dark", status.is_dark},
          {"dark_in_s", status.dark_in_s ? Json(*status.dark_in_s) : nothing},
          {"lit", status.lit},
          {"controls", status.controls},
          {"by", status.by},
          {"place", status.place},
          {"devices",
           {{"board",
             {{"port", rig.board.port},
              {"leds", rig.leds},
              {"open", status.devices_open},
              {"can_light_s", status.can_light_s}}},
            {"camera",
             {{"profile", rig.camera.profile},
              {"port", rig.camera.port},
              {"serial", rig.camera.serial},
              {"open", status.devices_open},
              {"exposures_us", status.exposures_us},
              {"says", status.camera ? to_json(*status.camera) : nothing}}}}}};
}

}  // namespace weft::app
