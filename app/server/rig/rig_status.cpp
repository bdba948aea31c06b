// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/rig_status.h"

#include "core/error_json.h"

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
  return {{"rig", rig.name},
          {"state", word_of(status.state)},
          {"phase", has_session ? Json(capture::name_of(status.scan.phase)) : nothing},
          {"session", has_session ? Json(status.session) : nothing},
          {"led", status.scan.led},
          {"frames", status.scan.frames},
          {"frames_planned", status.scan.frames_planned},
          {"exposure_us", status.scan.exposure_us},
          {"why", status.scan.why},
          {"error", status.error ? json_of(*status.error) : nothing},
          {"warnings", status.warnings},
          {"lit", status.lit},
          {"controls", status.controls},
          {"by", status.by},
          {"devices",
           {{"board", {{"port", rig.board.port}, {"leds", rig.leds}, {"open", status.devices_open}}},
            {"camera",
             {{"profile", rig.camera.profile},
              {"port", rig.camera.port},
              {"serial", rig.camera.serial},
              {"open", status.devices_open},
              {"says", status.camera ? to_json(*status.camera) : nothing}}}}}};
}

}  // namespace weft::app
