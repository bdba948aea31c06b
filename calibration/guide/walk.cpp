// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/walk.h"

#include <array>

namespace weft::calibration {
namespace {

constexpr WalkStage kProof = {.result = kWalkCheck,
                              .part = "check",
                              .title = "Proof",
                              .about = "Three sheets that nothing was fitted to.",
                              .job = "check",
                              .thing = "sheet"};

constexpr std::array kAll = {WalkStage{.result = "camera",
                                       .part = "board",
                                       .title = "Lens and place",
                                       .about = "A printed board in several poses.",
                                       .job = "calibrate_camera",
                                       .thing = "board"},
                             WalkStage{.result = "trap",
                                       .part = "trap",
                                       .title = "Veil of the lens",
                                       .about = "A black trap in white paper; for dark cloth.",
                                       .job = "calibrate_response",
                                       .thing = "",
                                       .is_optional = true,
                                       .is_aside = true},
                             WalkStage{.result = "response",
                                       .part = "response",
                                       .title = "Sensor",
                                       .about = "Anything that lies still, then the covered lens.",
                                       .job = "calibrate_response",
                                       .thing = ""},
                             WalkStage{.result = "lights",
                                       .part = "sheet",
                                       .title = "Lights",
                                       .about = "A white sheet in five poses.",
                                       .job = "calibrate_lights",
                                       .thing = "sheet"},
                             WalkStage{.result = "color",
                                       .part = "chart",
                                       .title = "Colour",
                                       .about = "One scan of a colour chart.",
                                       .job = "calibrate_color",
                                       .thing = "chart",
                                       .is_optional = true},
                             kProof};

constexpr std::array kRefresh = {
    WalkStage{.result = kWalkMoved,
              .part = "moved",
              .title = "What moved",
              .about = "The white sheet in three poses, among the tags of the table.",
              .job = "check",
              .thing = "sheet"},
    WalkStage{.result = "updated",
              .part = "moved",
              .title = "Fitted again",
              .about = "From the same photographs: nothing to lay.",
              .job = "calibrate_update",
              .thing = "sheet",
              .is_photographed = true},
    kProof};

Json json_of(std::span<const WalkStage> stages) {
  Json list = Json::array();
  for (const WalkStage& s : stages) {
    list.push_back({{"result", s.result},
                    {"part", s.part},
                    {"title", s.title},
                    {"about", s.about},
                    {"job", s.job},
                    {"thing", s.thing.empty() ? Json() : Json(s.thing)},
                    {"is_optional", s.is_optional},
                    {"is_aside", s.is_aside},
                    {"is_photographed", s.is_photographed}});
  }
  return list;
}

}  // namespace

std::span<const WalkStage> walk_of_all() {
  return kAll;
}

std::span<const WalkStage> walk_of_refresh() {
  return kRefresh;
}

Json json_of_walks() {
  return {{"all", json_of(kAll)}, {"refresh", json_of(kRefresh)}};
}

}  // namespace weft::calibration
