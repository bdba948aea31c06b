// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/rig_look.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "calibration/camera/pose.h"
#include "calibration/run/check_result.h"
#include "calibration/run/movement_words.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/describe/field_json.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "solve/session/current.h"

namespace weft::calibration {

namespace {

namespace fs = std::filesystem;

constexpr double kTurn_deg = 0.05;  // less is not worth a word
constexpr double kLevel = 0.01;     // what LEDs change by before it is said

// "LED 3 weaker by 2.4 percent".
std::string level_words(const std::string& who, double factor) {
  return fmt::format("{} {} by {:.1f} percent", who, factor < 1 ? "weaker" : "brighter",
                     100 * std::abs(factor - 1));
}

std::string moved_words(const std::string& who, const RigChange& change) {
  std::string words = fmt::format("{} moved {:.1f} mm", who, length(change.shift_mm));
  if (const double turn = length(change.turn_deg); turn >= kTurn_deg)
    words += fmt::format(" and turned {:.2f} degrees", turn);
  return words;
}

bool is_level(ChangeKind kind) {
  return kind == ChangeKind::kLedFaded || kind == ChangeKind::kAllFaded;
}

bool is_body(ChangeKind kind) {
  return kind == ChangeKind::kCamera || kind == ChangeKind::kTable;
}

std::string short_words(const RigChange& change) {
  const bool may_be_other =
      std::ranges::any_of(change.alternatives, [](const RigChange& other) { return is_body(other.kind); });
  const std::string led = fmt::format("LED {}", change.led);
  switch (change.kind) {
    case ChangeKind::kCamera:
    case ChangeKind::kTable:
      return moved_words(may_be_other                         ? "camera or table"
                         : change.kind == ChangeKind::kCamera ? "camera"
                                                              : "table",
                         change);
    case ChangeKind::kLedMoved:
      return moved_words(led, change);
    case ChangeKind::kLedFaded:
      return level_words(led, change.factor);
    case ChangeKind::kLedsSwapped:
      return fmt::format("LEDs {} and {} exchanged", change.led, change.other_led);
    case ChangeKind::kAllFaded:
      break;
  }
  return level_words("all LEDs", change.factor);
}

// "0.12 degrees", or what it costs of albedo where that is more to see.
std::string cost_words(const RigLook& look) {
  const MovementCost& cost = look.cost;
  const double albedo = std::max(std::abs(cost.albedo_factor - 1), cost.albedo_unevenness);
  if (cost.mean_deg < kLeastCost_deg && albedo >= kLeastCostAlbedo)
    return fmt::format("{:.1f} percent of albedo", 100 * albedo);
  const std::string most = fmt::format("{:.2f} degrees", cost.mean_deg);
  const std::string least = fmt::format("{:.2f}", look.least_deg);
  return most.starts_with(least) ? most : least + " to " + most;
}

// Whether tags alone were seen, and so a moved camera may be a moved table.
bool is_either(const Movement& movement) {
  return std::ranges::any_of(movement.changes, [](const RigChange& change) {
    return is_body(change.kind) && std::ranges::any_of(change.alternatives, [](const RigChange& other) {
             return is_body(other.kind);
           });
  });
}

// LEDs as a table sees them that moved to the camera as the camera is now seen to it.
NearLights seen_by_table(NearLights lights, const CameraModel& before, const CameraModel& after) {
  const Pose was = {before.camera_from_rig_rotation, before.camera_from_rig_translation_mm};
  const Pose is = {after.camera_from_rig_rotation, after.camera_from_rig_translation_mm};
  const Pose back = inverse(is) * was;
  for (NearLight& led : lights.leds) {
    led.position_mm = back(led.position_mm);
    led.aim = back.rotation * led.aim;
  }
  return lights;
}

void put_cost(RigLook& look, const Calibration& calibration, const RigEvidence& evidence,
              const Movement& movement) {
  const CameraModel& camera = *calibration.camera;
  const NearLights& lights = std::get<NearLights>(*calibration.lights);
  const auto cost = [&](const NearLights& after) {
    return cost_of(camera, levelled(lights, after, evidence.places), movement.camera, after);
  };
  look.cost = cost(movement.lights);
  look.least_deg = look.cost.mean_deg;
  if (!is_either(movement) || movement.readings > 0) return;
  const MovementCost of_camera = cost(lights),
                     of_table = cost(seen_by_table(lights, camera, movement.camera));
  look.cost = of_camera.mean_deg > of_table.mean_deg ? of_camera : of_table;
  look.least_deg = std::min(of_camera.mean_deg, of_table.mean_deg);
}

// What was not looked at for want of evidence.
std::string unseen_words(const Movement& movement) {
  if (movement.readings == 0) return ", its LEDs not seen: no white patch in sight";
  return movement.corners == 0 && movement.points == 0
             ? ", the camera against its table not seen: no tag and no fixed point in sight"
             : "";
}

// Who says so, where it is more than tags.
std::string by_words(const Movement& movement) {
  return movement.points == 0 ? "" : " by " + place_evidence_words(movement);
}

void judge(RigLook& look, const Movement& movement) {
  std::vector<std::string> moves, levels;
  for (const RigChange& change : movement.changes) {
    if (!is_level(change.kind)) moves.push_back(short_words(change));
    if (is_level(change.kind) && std::abs(change.factor - 1) >= kLevel) levels.push_back(short_words(change));
  }
  if (movement.chi_square_after > kUnexplainedFrom) {
    look.state = RigPlace::kUnexplained;
    look.says =
        "what tags, fixed points and patches show contradicts the calibration, and no move explains it";
    look.action = "see whether a patch is covered or a tag was laid elsewhere, else calibrate again";
  } else if (matters(look.cost)) {
    moves.insert(moves.end(), levels.begin(), levels.end());
    look.state = RigPlace::kMoved;
    look.says = fmt::format("{}, costs {}{}", fmt::join(moves, ", "), cost_words(look), by_words(movement));
    look.action = "calibrate again what moved";
  } else if (!levels.empty()) {
    look.state = RigPlace::kDimmed;
    look.says = fmt::format("{}, which its patches put right", fmt::join(levels, ", "));
  } else {
    look.state = RigPlace::kInPlace;
    look.says = fmt::format("in place{}{}", by_words(movement), unseen_words(movement));
  }
}

Result<void> check_lights(const Calibration& calibration, const fs::path& folder) {
  if (calibration.camera && calibration.lights && std::holds_alternative<NearLights>(*calibration.lights))
    return {};
  return Error{ErrorKind::kBadData, "the calibration cannot be checked", folder.string(),
               "it has no camera or no near lights", "calibrate camera and lights first"};
}

fs::path file_of(const Session& session) {
  return session.folder / kRigLookFile;
}

Result<void> keep(const Session& session, const RigLook& look) {
  Json document = {{"schema", fmt::format("{}/1", kRigLookSchema)}};
  write_fields(document, look);
  return write_json(file_of(session), document);
}

// As a document holds it, which has no NaN.
RigSightings without_nan(RigSightings seen) {
  for (SeenPatch& patch : seen.patches) {
    for (auto& reading : patch.reading_rgb) {
      for (double& value : reading) value = std::isfinite(value) ? value : 0;
    }
  }
  return seen;
}

}  // namespace

void describe(Fields& fields, TagSighting& tag) {
  std::array<std::array<double, 2>, 4> corners = {};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {tag.corners_px[i].x, tag.corners_px[i].y};
  fields.value({"dictionary", "As OpenCV names it", {}, kMustSay}, tag.dictionary);
  fields.value({"id", "Of the tag", {}, kMustSay}, tag.id);
  fields.value({"corners_px", "Upper left of the upright tag first, then clockwise", {}, kMustSay}, corners);
  for (std::size_t i = 0; i < 4; ++i) tag.corners_px[i] = {corners[i][0], corners[i][1]};
}

void describe(Fields& fields, SeenPatch& patch) {
  fields.value({"x_px", "Its middle", {}, kMustSay}, patch.x_px);
  fields.value({"y_px", "Its middle", {}, kMustSay}, patch.y_px);
  fields.value({"reading_rgb", "By LED; 0: not read", {}, kMustSay}, patch.reading_rgb);
  fields.value({"sigma", "Of each reading, relative: what few pixels leave of noise and grain"}, patch.sigma);
}

void describe(Fields& fields, PointSighting& point) {
  fields.value({"id", "Of the fixed point", {}, kMustSay}, point.id);
  fields.value({"x_px", "Its middle", {}, kMustSay}, point.x_px);
  fields.value({"y_px", "Its middle", {}, kMustSay}, point.y_px);
  fields.value({"sigma_px", "Of either, a standard deviation", kNotNegative, kMustSay}, point.sigma_px);
}

void describe(Fields& fields, RigLook& look) {
  describe(fields, static_cast<RigLookFacts&>(look));
  fields.value({"cost_mean_deg", "That normals are off on average, degrees"}, look.cost.mean_deg);
  fields.value({.name = "cost_least_deg",
                .says = "The same of the other, where a moved camera cannot be told from a moved table"},
               look.least_deg);
  fields.value({"cost_worst_deg", "That normals are off at worst, degrees"}, look.cost.worst_deg);
  fields.value({"albedo_factor", "Of solved over true albedo"}, look.cost.albedo_factor);
  fields.value({"albedo_unevenness", "Largest departure from that, relative"}, look.cost.albedo_unevenness);
  fields.value({"chi_square", "An observation, with the changes; 1 where all is well"}, look.chi_square);
  fields.value({"changes", "As `weft calibrate check` names them"}, look.changes);
  fields.list({"tags", "In sight"}, look.seen.tags);
  fields.list({"patches", "White ones of the calibration"}, look.seen.patches);
  fields.list({"points", "Fixed ones of the calibration, in sight", {}, kUnlessEmpty}, look.seen.points);
}

RigLook look_by(const Calibration& calibration, RigSightings seen, double paper_delta) {
  RigLook look;
  look.calibration = calibration.id;
  const RigEvidence evidence = evidence_of(calibration, seen);
  look.seen = std::move(seen);
  const Result<Movement> movement = find_movement(calibration, evidence, {.paper_delta = paper_delta});
  if (!movement) {
    look.says =
        "nothing of the rig is in sight: no tag or white patch of its calibration, nor four fixed points";
    look.action = "leave tags and patches beside the cloth";
    return look;
  }
  put_cost(look, calibration, evidence, *movement);
  look.chi_square = movement->chi_square_after;
  for (const RigChange& change : movement->changes) look.changes.push_back(json_of(change));
  judge(look, *movement);
  return look;
}

RigLook with_cloth_gains(RigLook look, const ClothGains& gains) {
  if (look.state != RigPlace::kInPlace && look.state != RigPlace::kUnseen) return look;
  std::vector<std::string> levels;
  for (const ClothGain& led : gains.leds) {
    if (std::abs(led.factor - 1) >= kLevel)
      levels.push_back(level_words(fmt::format("LED {}", led.led), led.factor));
  }
  if (levels.empty()) return look;
  look.state = RigPlace::kDimmed;
  look.says = fmt::format("{}, which the cloth tells and its solves put right", fmt::join(levels, ", "));
  look.action.clear();
  return look;
}

std::optional<RigLook> kept_look(const Session& session) {
  const Result<Json> document = read_json(file_of(session), kRigLookSchema, 1);
  if (!document) return std::nullopt;
  Result<RigLook> look = read_fields<RigLook>(*document, file_of(session).string());
  const bool is_todays = look && look->calibration == session.calibration_id &&
                         look->photographs == solve::digest_of_photographs(session);
  return is_todays ? std::optional(std::move(*look)) : std::nullopt;
}

Result<RigLook> look_at_scan(const Session& session, const JobContext& context) {
  if (std::optional<RigLook> kept = kept_look(session)) return std::move(*kept);
  const Result<solve::SolvePlan> plan = solve::plan_session({session.folder, {}, {}});
  if (!plan) return plan.error();
  if (Result<void> fits = check_lights(plan->calibration, session.calibration_folder()); !fits)
    return std::move(fits).error();
  const Result<solve::Photographs> loaded = solve::load_photographs(*plan, context);
  if (!loaded) return loaded.error();
  Result<RigSightings> seen = sightings_in(plan->calibration, *loaded);
  if (!seen) return std::move(seen).error();
  RigLook look =
      look_by(plan->calibration, without_nan(std::move(*seen)), reported_delta(session.calibration_folder()));
  if (const auto& gains = loaded->conditions.facts.cloth_gains)
    look = with_cloth_gains(std::move(look), *gains);
  look.taken = plan->lit.front().time;
  look.photographs = solve::digest_of_photographs(session);
  if (Result<void> kept = keep(session, look); !kept) return std::move(kept).error();
  return look;
}

Result<RigLook> look_by_another(const RigLook& look, const fs::path& folder) {
  const Result<Calibration> calibration = read_calibration(folder);
  if (!calibration) return calibration.error();
  if (calibration->id == look.calibration) return look;
  if (Result<void> fits = check_lights(*calibration, folder); !fits) return std::move(fits).error();
  RigLook another = look_by(*calibration, look.seen, reported_delta(folder));
  another.taken = look.taken;
  another.photographs = look.photographs;
  return another;
}

RigLook look_by_now(RigLook look, const fs::path& calibration) {
  if (calibration.empty()) return look;
  Result<RigLook> another = look_by_another(look, calibration);
  return another ? std::move(*another) : look;
}

fs::path looked_at_last(const fs::path& sessions) {
  fs::path last;
  fs::file_time_type when;
  std::error_code failed;
  for (fs::directory_iterator entry(sessions, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::error_code gone;
    const fs::file_time_type written = fs::last_write_time(entry->path() / kRigLookFile, gone);
    if (gone || (!last.empty() && written <= when)) continue;
    last = entry->path();
    when = written;
  }
  return last;
}

}  // namespace weft::calibration
