// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/test_shots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/describe/error_json.h"

namespace weft::app {
namespace {

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json to_json(const capture::FocusStanding& focus) {
  Json scores = Json::array(), cells = Json::array();
  for (const double score : focus.scores) scores.push_back(number_or_null(score));
  for (const double cell : focus.relative) cells.push_back(number_or_null(cell));
  return {{"scores", std::move(scores)},
          {"best", focus.best},
          {"columns", capture::FocusMap::kColumns},
          {"relative", std::move(cells)},
          {"more_right", focus.more_right ? Json(*focus.more_right) : Json()},
          {"more_below", focus.more_below ? Json(*focus.more_below) : Json()}};
}

const char* state_of(const TestShot& shot) {
  return shot.error ? "failed" : shot.frame ? "taken" : "taking";
}

}  // namespace

std::string stem_of_shot(int id) {
  return fmt::format("shot{:06}", id);
}

TestShot TestShots::begin(int led, double exposure_us) {
  TestShot shot;
  shot.id = ++newest_;
  shot.led = led;
  shot.exposure_us = exposure_us;
  shots_.push_back(shot);
  return shot;
}

std::vector<std::filesystem::path> TestShots::end(TestShot shot) {
  shots_.back() = std::move(shot);
  std::vector<std::filesystem::path> gone;
  for (; shots_.size() > kKept; shots_.pop_front()) {
    if (shots_.front().frame) gone.push_back(shots_.front().frame->file);
  }
  return gone;
}

Result<TestShot> TestShots::find(int id) const {
  const auto found = std::ranges::find(shots_, id, &TestShot::id);
  if (found != shots_.end()) return *found;
  return Error{ErrorKind::kNoInput, "no such test shot", std::to_string(id),
               fmt::format("the last {} are kept", kKept), "take another one"};
}

Json document_of(const TestShot& shot, FramePictures& pictures) {
  const Size size = shot.reading ? shot.reading->size : Size{};
  const std::optional<double> suggested_us = shot.reading ? shot.reading->suggested_us : std::nullopt;
  Json document = {{"id", shot.id},
                   {"led", shot.led},
                   {"exposure_us", shot.exposure_us},
                   {"state", state_of(shot)},
                   {"width", size.width},
                   {"height", size.height},
                   {"suggested_us", suggested_us ? Json(*suggested_us) : Json()},
                   {"clipped_rgb", Json()},
                   {"histogram", Json()},
                   {"focus", shot.reading ? to_json(shot.reading->focus) : Json()},
                   {"error", shot.error ? json_of(*shot.error) : Json()}};
  if (!shot.frame) return document;
  const Result<Json> histogram = pictures.histogram(*shot.frame);
  if (!histogram) {
    document["error"] = json_of(histogram.error());
    return document;
  }
  document["histogram"] = *histogram;
  document["clipped_rgb"] = {(*histogram)["red"]["clipped"], (*histogram)["green"]["clipped"],
                             (*histogram)["blue"]["clipped"]};
  return document;
}

}  // namespace weft::app
