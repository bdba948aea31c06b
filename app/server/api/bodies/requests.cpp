// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/requests.h"

#include "app/server/api/bodies/job_arguments.h"
#include "app/server/api/bodies/scan_body.h"

namespace weft::app {
namespace {

constexpr int kLongestHolder = 60, kLongestThing = 20'000;

NumberRange leds_from(int least, int most) {
  return {static_cast<double>(least), static_cast<double>(most)};
}

template <typename Request>
Json schema_of_request() {
  Request request;
  JobSchema schema;
  describe(schema, request);
  Json described = schema.schema();
  described["additionalProperties"] = false;
  return described;
}

}  // namespace

void describe(Fields& fields, DevicesRequest& request) {
  fields.value({.name = "open", .says = "true: for a person; false: close them", .need = kMustSay},
               request.open);
}

void describe(Fields& fields, LightRequest& request) {
  fields.value({.name = "leds",
                .says = "That light together; none: all are off",
                .range = leds_from(1, request.most_leds),
                .most = 2},
               request.leds);
  fields.require(request.leds.size() < 2 || request.leds[0] != request.leds[1], "leds",
                 "must be different ones");
  fields.value({"round",
                "In place of leds: one LED lights for as long as this is asked, each three seconds another "
                "one, as their heat allows"},
               request.round);
  fields.require(!request.round || request.leds.empty(), "leds", "must be absent where LEDs take turns");
  fields.need_one({"leds", "round"});
}

void describe(Fields& fields, TestShotRequest& request) {
  fields.value({.name = "led", .says = "0: none", .range = leds_from(0, request.most_leds), .need = kMustSay},
               request.led);
  fields.value({.name = "exposure_us",
                .says = "Shutter time; the camera's nearest is taken",
                .range = {1, kLongestShot_us},
                .need = kMustSay},
               request.exposure_us);
}

void describe(Fields& fields, AgainRequest& request) {
  fields.value(
      {"exposure_us",
       "0: the session's. Another one, whose ratio to it was measured, adds a bracket and supersedes "
       "nothing",
       {0, 1e9}},
      request.exposure_us);
}

void describe(Fields& fields, ControlRequest& request) {
  fields.value({.name = "name", .says = "Who commands", .most = kLongestHolder, .is_sentence = true},
               request.name);
  fields.value({"take", "Take them over from whoever holds them"}, request.take);
}

void describe(Fields& fields, SetWorkRequest& request) {
  fields.choice({.name = "part", .says = "What is photographed", .need = kMustSay}, request.part,
                calibration::kSetPartNames);
  fields.value({.name = "name",
                .says = "Of its folder in sets/ beside the rig file; default the part's",
                .is_sentence = true},
               request.name);
  fields.value({.name = "description",
                .says = "Text of board.toml, sheet.toml or chart.toml (docs/calibration.md); it or thing is "
                        "needed once",
                .most = kLongestThing,
                .has_lines = true},
               request.description);
  fields.value({"thing", "The same by its fields, as GET forms has them in things"}, request.thing);
  fields.exclude("thing", "description");
  fields.value({.name = "from",
                .says = "Folder of the calibration that was known before, below that of the rig file or an "
                        "absolute one of its machine; default the rig's",
                .is_sentence = true},
               request.from);
}

void describe(Fields& fields, LeaveOutRequest& request) {
  fields.value(
      {.name = "name", .says = "Of a photograph, as the set has it", .need = kMustSay, .is_sentence = true},
      request.name);
  fields.value({"out", "false: take it back"}, request.out);
}

void describe(Fields& fields, AcceptRequest& request) {
  fields.value({.name = "calibration", .says = "Its folder", .need = kMustSay, .path = PathTo::kFolder},
               request.calibration);
  fields.value({"dry_run", "Change nothing, and only say what would change"}, request.dry_run);
}

Json request_schemas() {
  return {{"ScanRequest", schema_of_request<ScanWish>()},
          {"DevicesRequest", schema_of_request<DevicesRequest>()},
          {"LightRequest", schema_of_request<LightRequest>()},
          {"TestShotRequest", schema_of_request<TestShotRequest>()},
          {"AgainRequest", schema_of_request<AgainRequest>()},
          {"ControlRequest", schema_of_request<ControlRequest>()},
          {"SetWorkRequest", schema_of_request<SetWorkRequest>()},
          {"LeaveOutRequest", schema_of_request<LeaveOutRequest>()},
          {"AcceptRequest", schema_of_request<AcceptRequest>()},
          {"TargetRequest", schema_of_request<calibration::TargetRequest>()}};
}

}  // namespace weft::app
