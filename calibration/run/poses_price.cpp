// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/poses_price.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/iso_time.h"

namespace weft::calibration {

std::optional<double> seconds_taken(const Session& session) {
  std::vector<double> times;
  for (const Shot& shot : session.shots) {
    if (const std::optional<double> time = seconds_of_iso_time(shot.time)) times.push_back(*time);
  }
  if (times.size() < 2) return {};
  const auto [first, last] = std::ranges::minmax(times);
  return (last - first) * static_cast<double>(times.size()) / static_cast<double>(times.size() - 1);
}

Result<void> choose_poses(PosesPrices& prices, const PosesWish& wish) {
  const auto is_quick = [&](const PosesPrice& row) { return !wish.within_s || row.rig_s <= *wish.within_s; };
  double best = std::numeric_limits<double>::infinity();
  for (const PosesPrice& row : prices.rows) {
    if (is_quick(row)) best = std::min(best, row.predicted_deg);
  }
  const double enough = wish.to_deg.value_or(best * (1 + kPosesGain));
  const auto chosen = std::ranges::find_if(
      prices.rows, [&](const PosesPrice& row) { return is_quick(row) && row.predicted_deg <= enough; });
  if (chosen != prices.rows.end()) {
    chosen->is_chosen = true;
    return {};
  }
  return Error{ErrorKind::kUsage, "no so many poses are that close and that quick",
               fmt::format("--to {:g}", enough),
               fmt::format("the best {} is {:.3g} degrees",
                           wish.within_s ? "in that time" : "by ten more poses", best),
               "ask for what --explain lists"};
}

void describe(Fields& fields, PosesPrice& price) {
  fields.value({"more", "Poses that are not there yet"}, price.more);
  fields.value({"poses", "With those that are"}, price.poses);
  fields.value({"rig_s", "At the rig, for those that are not there"}, price.rig_s);
  fields.value({"fit_s", "Of fitting all"}, price.fit_s);
  fields.value({"predicted_deg", "What its errors turn a normal by, rms over the frame"},
               price.predicted_deg);
  fields.value({.name = "focal_percent", .says = "Sigma of a camera's focal length", .need = kOrNull},
               price.focal_percent);
  fields.value({.name = "place_mm", .says = "Sigma of a pixel's place on the table", .need = kOrNull},
               price.place_mm);
  fields.value({.name = "position_mm", .says = "Sigma of the LED that is known worst", .need = kOrNull},
               price.position_mm);
  fields.value({"chosen", "The one to buy"}, price.is_chosen);
}

void describe(Fields& fields, PosesWish& wish) {
  fields.value(
      {.name = "explain",
       .says = "Write nothing: say what these photographs let a calibration know, what 1, 2, 5 and 10 "
               "more poses would, and the seconds",
       .said = Said::kAtThisMachine},
      wish.only_explains);
  fields.value({.name = "to_deg",
                .says = "With --explain: the fewest poses by which normals are so many degrees off",
                .range = kAboveZero,
                .said = Said::kAtThisMachine},
               wish.to_deg);
  fields.value({.name = "within_s",
                .says = "With --explain: the fewest that are as good as any in so many seconds at the rig",
                .range = kNotNegative,
                .said = Said::kAtThisMachine},
               wish.within_s);
  for (const char* aim : {"to_deg", "within_s"}) fields.need(aim, "explain");
}

void describe(Fields& fields, PosesPrices& prices) {
  fields.value({"thing", "That is laid under the camera"}, prices.thing);
  fields.list({"rows", "Fewest poses first"}, prices.rows);
}

}  // namespace weft::calibration
