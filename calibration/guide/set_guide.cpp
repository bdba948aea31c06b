// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/set_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>
#include <utility>

#include "calibration/camera/guidance.h"
#include "calibration/camera/markers.h"
#include "calibration/guide/owned_target.h"
#include "calibration/guide/pose_words.h"
#include "calibration/guide/response_series.h"
#include "calibration/guide/scan_judgement.h"
#include "calibration/run/check_result.h"
#include "calibration/run/sheet_files.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/base/statistics.h"
#include "core/rig/session.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kTooAlike = 0.7;      // calibration::BoardGuidance::alike
constexpr double kMostMisfit = 2.5;    // times the median residual of the others
constexpr std::size_t kToCompare = 4;  // views whose median says what a residual is

std::vector<std::string> names_in(const fs::path& folder, bool sessions) {
  constexpr std::array kNoPhotographs = {".toml", ".json"};
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string(), ending = entry.path().extension().string();
    const bool is_other = std::ranges::find(kNoPhotographs, ending) != kNoPhotographs.end();
    const bool is_wanted = sessions ? entry.is_directory(ignored) && ending == ".weft"
                                    : entry.is_regular_file(ignored) && !is_other;
    if (is_wanted && !name.starts_with('.')) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

void add_left_out(const PhotographSet& set, SetStanding& standing) {
  const bool of_sessions = set.is_of_sheets() || set.part == SetPart::kChart;
  for (const std::string& name : names_in(set.left_out(), of_sessions))
    standing.photographs.push_back(
        {name, false, true, set.why.value(name, "it was left out"), Json::object()});
}

/// The first name of this kind that nothing in the set has, left out or not.
std::string free_name(const PhotographSet& set, const char* kind) {
  std::set<std::string> taken;
  for (const fs::path& folder : {set.folder, set.left_out()}) {
    for (const bool sessions : {false, true}) {
      for (const std::string& name : names_in(folder, sessions)) taken.insert(fs::path(name).stem().string());
    }
  }
  for (int number = 1;; ++number) {
    if (std::string name = fmt::format("{}{:02}", kind, number); !taken.contains(name)) return name;
  }
}

Result<Calibration> known_before(const PhotographSet& set) {
  if (!set.from.empty()) return read_calibration(set.from);
  return Error{ErrorKind::kUsage, "nothing is known of the rig", set.folder.string(),
               "the set names no calibration to begin with",
               "name the one that is to be made better, or what a data sheet and a tape say"};
}

Result<CameraModel> camera_known_before(const PhotographSet& set) {
  const Result<Calibration> before = known_before(set);
  if (!before) return before.error();
  if (before->camera) return *before->camera;
  return Error{ErrorKind::kBadData, "nothing is known of the camera", set.from.string(),
               "the calibration has no camera", "name one that has, be it from a data sheet"};
}

Json json_of(const PixelPoint& p) {
  return {std::round(10 * p.x) / 10, std::round(10 * p.y) / 10};
}

Json json_of(const std::array<PixelPoint, 4>& outline) {
  Json corners = Json::array();
  for (const PixelPoint& p : outline)
    corners.push_back({std::round(1e5 * p.x) / 1e5, std::round(1e5 * p.y) / 1e5});
  return corners;
}

Json json_of(const BoardPose& pose, Size size) {
  Json outline_px = Json::array(), outline = Json::array();
  for (const PixelPoint& p : pose.outline_px) {
    outline_px.push_back(json_of(p));
    outline.push_back({(p.x + 0.5) / size.width, (p.y + 0.5) / size.height});
  }
  return {{"x_mm", pose.x_mm},
          {"y_mm", pose.y_mm},
          {"height_mm", pose.height_mm},
          {"tilt_deg", pose.tilt_deg},
          {"azimuth_deg", pose.azimuth_deg},
          {"outline_px", std::move(outline_px)},
          {"outline", std::move(outline)}};
}

Json json_of(const LensForecast& forecast) {
  return {{"focal_percent", forecast.focal_percent}, {"place_mm", forecast.place_mm}};
}

/// What the board is seen to have been: bent, or another one, where its residual is far from the others'.
void judge_residuals(const std::vector<std::size_t>& viewed, const BoardGuidance& guidance,
                     SetStanding& standing) {
  if (viewed.size() < kToCompare) return;
  const double middle = median(guidance.residuals_px);
  for (std::size_t i = 0; i < viewed.size(); ++i) {
    if (guidance.residuals_px[i] <= kMostMisfit * middle) continue;
    SetPhotograph& photograph = standing.photographs[viewed[i]];
    photograph.is_used = false;
    photograph.why = fmt::format(
        "the board was bent, or moved while it was photographed: its corners are {:.2f} pixels "
        "from where it should have them, the others' {:.2f}",
        guidance.residuals_px[i], middle);
  }
}

SetStep step_to(const PhotographSet& set, const BoardGuidance& guidance) {
  SetStep step;
  step.name = free_name(set, "board");
  step.pose = json_of(*guidance.next, guidance.camera.size);
  step.says = words_of(*guidance.next, guidance.camera);
  return step;
}

SetStep step_to_table(const PhotographSet& set) {
  return {StepKind::kPhotograph, free_name(set, "table"),
          "lay the board flat on the table, in the middle of the picture, its rows along the table's x axis",
          Json()};
}

/// Why a thing is not seen, and what of the rig's lies there instead.
std::string with_what_lies_there(std::string why, View<const std::uint8_t> grey, const PhotographSet& set) {
  std::vector<OwnedTarget> targets = owned_targets(set.folder.parent_path().parent_path());
  const Result<std::string> described =
      read_text(set.part == SetPart::kBoard ? set.board_file() : set.sheet_file());
  std::erase_if(targets, [&](const OwnedTarget& each) { return described && each.text == *described; });
  const OwnedTarget* there = target_in(grey, targets);
  return there == nullptr ? why : fmt::format("{} lies there; {}", there->says, why);
}

SetPhotograph judged(const BoardPhotograph& board, Size size) {
  SetPhotograph photograph;
  photograph.name = board.name;
  photograph.is_used = board.left_out.empty();
  photograph.why = board.left_out;
  photograph.facts = {{"corners", board.sighting.corners.size()}, {"edge_px", board.sighting.edge_px}};
  if (photograph.is_used && board.size != size) {
    photograph.is_used = false;
    photograph.why = fmt::format("it has {} x {} pixels, the camera {} x {}", board.size.width,
                                 board.size.height, size.width, size.height);
  }
  return photograph;
}

/// What the guidance found, of the set and of each photograph that was viewed.
void tell(const BoardGuidance& guidance, const GuidanceOptions& asked, const std::vector<std::size_t>& viewed,
          SetStanding& standing) {
  for (std::size_t i = 0; i < viewed.size(); ++i) {
    Json& facts = standing.photographs[viewed[i]].facts;
    facts["rms_px"] = guidance.residuals_px[i];
    if (guidance.alike[i] > kTooAlike) facts["note"] = "it is much like one before and adds little";
  }
  Json arrows = Json::array();
  for (const PixelPoint& p : guidance.mean_residual_px)
    arrows.push_back({std::round(1000 * p.x) / 1000, std::round(1000 * p.y) / 1000});
  judge_residuals(viewed, guidance, standing);
  standing.figures = {
      {"coverage",
       {{"columns", asked.columns},
        {"rows", asked.rows},
        {"corners", guidance.corners},
        {"seen", guidance.parts_seen},
        {"residual_px", std::move(arrows)}}},
      {"predicted", json_of(guidance.now)},
      {"asked", {{"focal_percent", asked.asked_focal_percent}, {"place_mm", asked.asked_place_mm}}}};
  if (guidance.next) standing.figures["then"] = json_of(guidance.then);
  standing.is_done = guidance.is_done;
}

/// How boards lie against what was asked: each tells of the lens all the same.
void judge_boards(const PhotographSet& set, const BoardGuidance& guidance,
                  const std::vector<std::size_t>& viewed, std::optional<std::size_t> table,
                  SetStanding& standing) {
  constexpr double kOff_deg = 12;
  for (std::size_t i = 0; i < viewed.size(); ++i) {
    SetPhotograph& photograph = standing.photographs[viewed[i]];
    const double tilt_deg = guidance.tilt_deg[i];
    photograph.facts["tilt_deg"] = tilt_deg;
    if (photograph.facts.contains("note")) continue;
    if (i == table && !set.from.empty() && guidance.table_tilt_deg > kOff_deg) {
      photograph.facts["note"] = fmt::format(
          "by the calibration before it is tilted by {:.0f} degrees: unless the camera was moved, leave it "
          "out and lay the board flat",
          guidance.table_tilt_deg);
    }
    const auto stem = fs::path(photograph.name).stem().string();
    const Json asked = set.asked.contains(stem) ? set.asked[stem] : Json();
    if (!asked.is_object() || !asked.value("tilt_deg", Json()).is_number()) continue;
    const double asked_deg = asked["tilt_deg"];
    if (std::abs(asked_deg - tilt_deg) > kOff_deg)
      photograph.facts["note"] = fmt::format("it counts; {:.0f} degrees of tilt were asked", asked_deg);
  }
}

/// A camera, and how well its focal length is known.
struct KnownCamera {
  CameraModel camera;
  double focal_sigma = 0;
};

/// The camera of the calibration that was known before; of a rig that has none, one with a usual lens as high
/// over the first board as makes it as large as it is seen.
Result<KnownCamera> camera_before_boards(const PhotographSet& set,
                                         const std::vector<const BoardPhotograph*>& boards) {
  if (!set.from.empty()) {
    const Result<CameraModel> camera = camera_known_before(set);
    if (!camera) return camera.error();
    return KnownCamera{*camera, GuidanceOptions().start_focal_sigma};
  }
  constexpr double kUsualLens = 2, kUsualSigma = 0.5;  // focal length over the frame's width
  for (const BoardPhotograph* each : boards) {
    if (!each->left_out.empty() || each->sighting.corners.size() < 2) continue;
    const BoardCorner &a = each->sighting.corners.front(), &b = each->sighting.corners.back();
    const double mm_per_pixel =
        std::hypot(b.u_mm - a.u_mm, b.v_mm - a.v_mm) / std::hypot(b.px.x - a.px.x, b.px.y - a.px.y);
    const double height_mm = kUsualLens * each->size.width * mm_per_pixel;
    return KnownCamera{overhead_camera(each->size, height_mm, mm_per_pixel), kUsualSigma};
  }
  return KnownCamera{boards.empty() ? CameraModel() : overhead_camera(boards.front()->size, 1, 1),
                     kUsualSigma};
}

}  // namespace

Result<std::vector<const BoardPhotograph*>> SetGuide::read_boards(const PhotographSet& set,
                                                                  const PrintedBoard& printed) {
  std::vector<const BoardPhotograph*> boards;
  for (const std::string& name : names_in(set.folder, false)) {
    auto known = boards_.find(name);
    if (known == boards_.end()) {
      Result<BoardPhotograph> read =
          read_board_photograph(set.folder / name, {.folder = set.folder, .board = printed.board});
      if (!read) return std::move(read).error();
      const BoardFault fault = read->sighting.fault;
      if (fault == BoardFault::kNotFound || fault == BoardFault::kWrongSquares) {
        if (const Result<RawFrame> frame = capture::decode_raw(set.folder / name)) {
          const Image<std::uint8_t> grey = grey_picture(*frame);
          read->left_out = with_what_lies_there(std::move(read->left_out), grey.plane(), set);
        }
      }
      known = boards_.emplace(name, *read).first;
    }
    boards.push_back(&known->second);
  }
  return boards;
}

Result<SetStanding> SetGuide::look_at_boards(const PhotographSet& set) {
  const Result<PrintedBoard> printed = read_board_file(set.board_file(), {});
  if (!printed) return printed.error();
  const Result<std::vector<const BoardPhotograph*>> boards = read_boards(set, *printed);
  if (!boards) return boards.error();
  const Result<KnownCamera> start = camera_before_boards(set, *boards);
  if (!start) return start.error();

  SetStanding standing;
  std::vector<BoardView> views;
  std::vector<std::size_t> viewed;
  std::optional<std::size_t> table;
  for (const BoardPhotograph* board : *boards) {
    standing.photographs.push_back(judged(*board, start->camera.size));
    if (!standing.photographs.back().is_used) continue;
    if (board->of_table && !table) table = views.size();
    viewed.push_back(standing.photographs.size() - 1);
    views.push_back({board->name, board->sighting.corners});
  }
  GuidanceOptions asked;
  asked.start_focal_sigma = start->focal_sigma;
  if (!views.empty() || !set.from.empty()) {
    const BoardGuidance guidance =
        guide_board(printed->board, printed->thickness_mm, start->camera, views, table, asked);
    tell(guidance, asked, viewed, standing);
    judge_boards(set, guidance, viewed, table, standing);
    if (guidance.next) standing.next = step_to(set, guidance);
  }
  if (!table) standing.next = step_to_table(set);
  add_left_out(set, standing);
  return standing;
}

namespace {

constexpr const char *kLeft = "left edge", *kRight = "right edge", *kNear = "edge towards you",
                     *kFar = "far edge";
constexpr double kTilted_deg = 9;
constexpr std::array kSheets = {
    WantedLay{.name = "sheet01",
              .says = "lay the white sheet flat on the table, in the middle of the picture",
              .is_in_middle = true},
    WantedLay{"sheet02", 20, 0, kLeft, "tilt the sheet by 20 degrees: raise its left edge", kTilted_deg},
    WantedLay{"sheet03", 20, 180, kRight, "tilt the sheet by 20 degrees: raise its right edge", kTilted_deg},
    WantedLay{"sheet04", 20, 90, kNear, "tilt the sheet by 20 degrees: raise the edge towards you",
              kTilted_deg},
    WantedLay{"sheet05", 20, 270, kFar, "tilt the sheet by 20 degrees: raise the far edge", kTilted_deg}};
constexpr std::array kChecks = {
    WantedLay{.name = "turned",
              .says = "lay the sheet flat again, turned by 90 degrees in its plane",
              .is_turned = true},
    WantedLay{.name = "other",
              .says = "lay another white sheet flat on the table; the same one turned over will do"},
    WantedLay{"plane", 15, 210, "", "tilt the sheet by about 15 degrees, raising a corner", 8}};
// By a camera that may have been knocked.
constexpr std::array kMoved = {
    WantedLay{
        .name = "moved",
        .says = "clear the table but for its tags and patches, and lay the white sheet flat in the middle",
        .within_deg = kTilted_deg,
        .within_mm = 50},
    WantedLay{"tilted", 20, 0, kLeft, "tilt the sheet by 20 degrees: raise its left edge", kTilted_deg},
    WantedLay{"turned", 20, 90, kNear, "tilt the sheet by 20 degrees: raise the edge towards you",
              kTilted_deg}};

std::span<const WantedLay> wanted_by(SetPart part) {
  if (part == SetPart::kSheet) return kSheets;
  if (part == SetPart::kCheck) return kChecks;
  return kMoved;
}

Result<SheetPose> sheet_in(View<const std::uint8_t> grey, const TaggedSheet& sheet, const CameraModel& camera,
                           const std::string& where) {
  std::set<std::string> dictionaries;
  for (const SheetTag& tag : sheet.tags) dictionaries.insert(tag.dictionary);
  std::vector<TagSighting> sightings;
  for (const std::string& dictionary : dictionaries) {
    const auto found = find_tags(grey, dictionary);
    if (!found) return found.error();
    sightings.insert(sightings.end(), found->begin(), found->end());
  }
  return sheet_pose(camera, sightings, sheet.tags, where);
}

SetPhotograph judged(const fs::path& folder, const TaggedSheet& sheet, const CameraModel& camera,
                     const PhotographSet& set) {
  SetPhotograph photograph;
  photograph.name = folder.filename().string();
  photograph.is_used = false;
  const Result<Image<std::uint8_t>> grey = grey_of_session(folder);
  if (!grey) {
    photograph.why = grey.error().message();
    return photograph;
  }
  const Result<SheetPose> pose = sheet_in(grey->plane(), sheet, camera, photograph.name);
  if (!pose) {
    photograph.why = with_what_lies_there(pose.error().message(), grey->plane(), set);
    return photograph;
  }
  const Result<Session> session = read_session(folder);
  photograph.why = session ? lamp_in(*session) : session.error().message();
  if (photograph.why.empty()) photograph.why = unevenness_of(*session, camera, sheet, *pose);
  photograph.is_used = photograph.why.empty();
  photograph.lay = lay_of(pose->rig_from_sheet, sheet.sheet);
  const Vec3 normal = photograph.lay->normal;
  photograph.facts = {{"tags", pose->tags},
                      {"tilt_deg", angle_deg(normal, {0, 0, 1})},
                      {"azimuth_deg", degrees(std::atan2(normal.y, normal.x))},
                      {"turn_deg", photograph.lay->turn_deg},
                      {"residual_px", pose->residual_px},
                      {"normal", {normal.x, normal.y, normal.z}},
                      {"outline", json_of(outline_of(pose->rig_from_sheet, sheet.sheet, camera))}};
  return photograph;
}

SetPhotograph judged_chart(const Session& session, const PhotographSet& set) {
  SetPhotograph photograph;
  photograph.name = session.folder.filename().string();
  photograph.why = lamp_in(session);
  const ChartLook look = look_at_chart_scan(session, set.folder, set.from);
  if (photograph.why.empty()) photograph.why = look.why_not;
  photograph.is_used = photograph.why.empty();
  if (!photograph.is_used && look.outline.empty()) {
    if (const Result<Image<std::uint8_t>> grey = grey_of_session(session.folder))
      photograph.why = with_what_lies_there(std::move(photograph.why), grey->plane(), set);
  }
  if (!look.note.empty()) photograph.facts["note"] = look.note;
  if (!look.outline.empty()) photograph.facts["outline"] = look.outline;
  return photograph;
}

/// What is new to the LEDs is another tilt, or another part of the paper.
bool is_alike(const SheetLay& a, const SheetLay& b) {
  constexpr double kSameTilt_deg = 3, kSameTurn_deg = 30;
  return angle_deg(a.normal, b.normal) < kSameTilt_deg && between_deg(a.turn_deg, b.turn_deg) < kSameTurn_deg;
}

/// Nobody lays a sheet down twice so alike.
bool is_untouched(const SheetLay& a, const SheetLay& b) {
  constexpr double kSame_deg = 0.5, kSame_mm = 0.5;
  return angle_deg(a.normal, b.normal) < kSame_deg && between_deg(a.turn_deg, b.turn_deg) < kSame_deg &&
         length(a.centre_mm - b.centre_mm) < kSame_mm;
}

/// A sheet that lies as one before it tells nothing new of the LEDs.
void judge_likeness(SetStanding& standing) {
  for (std::size_t i = 1; i < standing.photographs.size(); ++i) {
    SetPhotograph& one = standing.photographs[i];
    for (std::size_t before = 0; before < i && one.is_used; ++before) {
      const SetPhotograph& other = standing.photographs[before];
      if (!other.is_used || !is_alike(*one.lay, *other.lay)) continue;
      one.is_used = false;
      one.why = fmt::format("the sheet lies as it did in {}", other.name);
    }
  }
}

/// Sheets are held against what was asked. Of a proof one that lies otherwise is not used; else it tells of
/// the LEDs all the same, and what was asked is asked again.
void judge_departures(const PhotographSet& set, SheetAim aim, SetStanding& standing) {
  const bool is_proof = set.part == SetPart::kCheck;
  std::vector<const SetPhotograph*> before;
  for (const WantedLay& wanted : wanted_by(set.part)) {
    aim.wanted = wanted;
    for (SetPhotograph& photograph : standing.photographs) {
      if (!photograph.lay || !photograph.name.starts_with(wanted.name)) continue;
      std::string wrong = departure_of(*photograph.lay, aim);
      for (const SetPhotograph* other : before) {
        if (is_proof && wrong.empty() && is_untouched(*photograph.lay, *other->lay))
          wrong = fmt::format("nothing has changed since {}: lay another sheet", other->name);
      }
      if (wrong.empty()) continue;
      if (!photograph.is_used) {
        photograph.why += "; " + wrong;
      } else if (is_proof) {
        photograph.is_used = false;
        photograph.why = std::move(wrong);
      } else {
        photograph.facts["note"] = "it counts, and was asked otherwise: " + wrong;
      }
    }
    for (const SetPhotograph& photograph : standing.photographs) {
      if (photograph.is_used && photograph.lay && photograph.name.starts_with(wanted.name))
        before.push_back(&photograph);
    }
  }
}

/// Whether a sheet that is used lies as is wanted.
bool is_met(const PhotographSet& set, const SheetAim& aim, const SetStanding& standing) {
  return std::ranges::any_of(standing.photographs, [&](const SetPhotograph& p) {
    if (!p.is_used) return false;
    return set.part == SetPart::kCheck ? p.name.starts_with(aim.wanted.name)
                                       : p.lay && departure_of(*p.lay, aim).empty();
  });
}

/// The name of a scan that was begun for this, or one that nothing in the set has.
std::string unfinished_or_free(const PhotographSet& set, const std::string& name) {
  for (int number = 1;; ++number) {
    std::string session =
        number == 1 ? fmt::format("{}.weft", name) : fmt::format("{}_{}.weft", name, number);
    const Result<Session> begun = read_session(set.folder / session);
    const bool is_taken = is_there(set.folder / session) || is_there(set.left_out() / session);
    if (!is_taken || (begun && begun->state != "complete")) return session;
  }
}

SetStep step_to(const SheetAim& aim, std::string session) {
  return {StepKind::kScan,
          std::move(session),
          aim.wanted.says,
          {{"tilt_deg", aim.wanted.tilt_deg},
           {"azimuth_deg", aim.wanted.azimuth_deg},
           {"outline", json_of(outline_of(aim))}}};
}

}  // namespace

Result<SetStanding> SetGuide::look_at_sheets(const PhotographSet& set) {
  const Result<CameraModel> camera = camera_known_before(set);
  if (!camera) return camera.error();
  const Result<TaggedSheet> sheet = read_sheet_file(set.sheet_file());
  if (!sheet) return sheet.error();
  SetStanding standing;
  for (const std::string& name : names_in(set.folder, true)) {
    if (!sessions_.contains(name)) {
      SetPhotograph photograph = judged(set.folder / name, *sheet, *camera, set);
      const Result<Session> session = read_session(set.folder / name);
      if (!session || session->state != "complete") {
        standing.photographs.push_back(std::move(photograph));
        continue;
      }
      sessions_.emplace(name, std::move(photograph));
    }
    standing.photographs.push_back(sessions_.at(name));
  }
  SheetAim aim = {*sheet, *camera, {}, fitted_turns_deg(set.from)};
  if (set.part != SetPart::kCheck) judge_likeness(standing);
  judge_departures(set, aim, standing);
  for (const WantedLay& each : wanted_by(set.part)) {
    aim.wanted = each;
    if (standing.next || is_met(set, aim, standing)) continue;
    standing.next = step_to(aim, unfinished_or_free(set, each.name));
    standing.aim = aim;
  }
  standing.is_done = !standing.next;
  add_left_out(set, standing);
  return standing;
}

Result<SetStanding> SetGuide::look_at_chart(const PhotographSet& set) {
  SetStanding standing;
  for (const std::string& name : names_in(set.folder, true)) {
    const Result<Session> session = read_session(set.folder / name);
    if (!session || session->state != "complete") continue;
    if (!sessions_.contains(name)) sessions_.emplace(name, judged_chart(*session, set));
    standing.photographs.push_back(sessions_.at(name));
    standing.is_done = standing.is_done || standing.photographs.back().is_used;
  }
  if (!standing.is_done) {
    standing.next =
        SetStep{StepKind::kScan, unfinished_or_free(set, "chart"),
                "lay the colour chart flat on the table, dark skin at the upper left of the picture", Json()};
  }
  add_left_out(set, standing);
  return standing;
}

Result<SetStanding> SetGuide::look(const PhotographSet& set) {
  switch (part_) {
    case SetPart::kBoard:
      return look_at_boards(set);
    case SetPart::kSheet:
    case SetPart::kCheck:
    case SetPart::kMoved:
      return look_at_sheets(set);
    case SetPart::kChart:
      return look_at_chart(set);
    case SetPart::kResponse:
    case SetPart::kTrap:
      break;
  }
  return look_at_series(set);
}

Json json_of(const SetStep& step) {
  constexpr std::array kKinds = {"photograph", "series", "scan"};
  return {{"name", step.name},
          {"kind", kKinds[static_cast<std::size_t>(step.kind)]},
          {"says", step.says},
          {"pose", step.pose}};
}

Json json_of(const SetStanding& standing) {
  Json photographs = Json::array();
  for (const SetPhotograph& p : standing.photographs) {
    photographs.push_back({{"name", p.name},
                           {"used", p.is_used},
                           {"left_out", p.is_left_out},
                           {"why", p.why},
                           {"facts", p.facts}});
  }
  return {{"photographs", std::move(photographs)},
          {"figures", standing.figures},
          {"next", standing.next ? json_of(*standing.next) : Json()},
          {"done", standing.is_done}};
}

}  // namespace weft::calibration
