// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "calibration/camera/finder.h"
#include "core/base/files.h"
#include "core/rig/light_field.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr int kColumns = 12, kRows = 8;
constexpr const char* kTableTags = "DICT_APRILTAG_36h11";

Vec3 on_table(const CameraModel& camera, double x_share, double y_share) {
  return point_on_plane(camera, x_share * camera.size.width - 0.5, y_share * camera.size.height - 0.5, 0);
}

/// What level white cloth reads, of the brightest cell's.
FrameGrid light_over(const CameraModel& camera, const Lights& lights) {
  const Result<LightField> field = LightField::make(lights, camera, camera.size, 0);
  if (!field) return {};
  FrameGrid grid = {kColumns, kRows, {}};
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const int x = (2 * column + 1) * camera.size.width / (2 * kColumns);
      const int y = (2 * row + 1) * camera.size.height / (2 * kRows);
      double sum = 0;
      for (std::size_t k = 0; k < field->count(); ++k) {
        const LightField::Light light = field->at(k, 1, x, y);
        sum += light.strength * std::max(light.direction.z, 0.0);
      }
      grid.values.push_back(sum);
    }
  }
  const double brightest = *std::ranges::max_element(grid.values);
  for (double& value : grid.values) value /= brightest;
  return brightest > 0 ? grid : FrameGrid();
}

/// As the report of the lights has it.
FrameGrid predicted_by(const fs::path& calibration) {
  const Result<Json> report = read_json(calibration / "report" / "lights.json", "weft.calibration-report", 1);
  if (!report) return {};
  const Json predicted = report->value("numbers", Json::object()).value("predicted_normal_deg", Json());
  if (!predicted.is_object() || !predicted.value("grid", Json()).is_array()) return {};
  FrameGrid grid = {predicted.value("columns", 0), predicted.value("rows", 0), {}};
  for (const Json& value : predicted["grid"])
    grid.values.push_back(value.is_number() ? value.get<double>() : std::nan(""));
  const bool fits = grid.values.size() == static_cast<std::size_t>(std::max(grid.columns * grid.rows, 0));
  return fits ? grid : FrameGrid();
}

std::string name_of_tag(const std::string& dictionary, int id) {
  return fmt::format("{} {}", dictionary, id);
}

void see_board(View<const std::uint8_t> grey, const PrintedBoard& board, SeenFrame& seen) {
  const BoardSighting sighting = find_board(grey, board.board);
  seen.corners = static_cast<int>(sighting.corners.size());
  if (seen.corners > 2) seen.board = FramedShape{"board", outline_of(sighting.corners, grey.size())};
  seen.says = seen.corners > 0 ? fmt::format("{} corners of the board are seen.", seen.corners)
                               : std::string("No board is seen.");
}

/// By the tags as the camera itself would see them.
void see_sheet(std::vector<TagSighting> tags, Size size, const SheetAim& aim, SeenFrame& seen) {
  constexpr double kMiss = 0.005;  // of the frame's width: a finder has few pixels
  for (TagSighting& tag : tags) {
    for (PixelPoint& corner : tag.corners_px) {
      const PixelPoint share = share_of(corner, size);
      corner = {share.x * aim.camera.size.width - 0.5, share.y * aim.camera.size.height - 0.5};
    }
  }
  const Result<SheetPose> pose =
      sheet_pose(aim.camera, tags, aim.sheet.tags, "live view", kMiss * aim.camera.size.width);
  seen.says = "No sheet is seen.";
  if (!pose) return;
  const std::array<PixelPoint, 4> outline = outline_of(pose->rig_from_sheet, aim.sheet.sheet, aim.camera);
  seen.sheet = FramedShape{"sheet", {outline.begin(), outline.end()}};
  const std::string wrong = departure_of(lay_of(pose->rig_from_sheet, aim.sheet.sheet), aim);
  seen.says = wrong.empty() ? "The sheet lies as asked." : fmt::format("Not yet: {}.", wrong);
}

Json json_of(const FrameGrid& grid) {
  if (grid.values.empty()) return Json();
  Json values = Json::array();
  for (const double value : grid.values)
    values.push_back(std::isfinite(value) ? Json(std::round(1e4 * value) / 1e4) : Json());
  return {{"columns", grid.columns}, {"rows", grid.rows}, {"values", std::move(values)}};
}

Json json_of(const FramedShape& shape) {
  Json corners = Json::array();
  for (const PixelPoint& p : shape.corners)
    corners.push_back({std::round(1e5 * p.x) / 1e5, std::round(1e5 * p.y) / 1e5});
  return {{"name", shape.name}, {"corners", std::move(corners)}};
}

}  // namespace

Result<KnownFrame> known_frame(const fs::path& folder) {
  const Result<Calibration> calibration = read_calibration(folder);
  if (!calibration) return calibration.error();
  if (!calibration->camera) {
    return Error{ErrorKind::kBadData, "nothing is known of the frame", folder.string(),
                 "the calibration has no camera", "measure it: weft calibrate all"};
  }
  KnownFrame known;
  known.camera = *calibration->camera;
  known.width_mm = length(on_table(known.camera, 1, 0.5) - on_table(known.camera, 0, 0.5));
  known.height_mm = length(on_table(known.camera, 0.5, 1) - on_table(known.camera, 0.5, 0));
  if (calibration->lights) known.light = light_over(known.camera, *calibration->lights);
  known.normal_deg = predicted_by(folder);
  known.fiducials = calibration->fiducials;
  return known;
}

Result<SeenFrame> seen_frame(const std::string& jpeg, const std::optional<KnownFrame>& known,
                             const AimedThing& aim) {
  const std::optional<Image<std::uint8_t>> picture = finder_picture(jpeg);
  if (!picture) {
    return Error{ErrorKind::kProtocol, "the finder gave no picture", "live view", "it is no JPEG",
                 "ask for the next one"};
  }
  const View<const std::uint8_t> grey = picture->plane();
  const Size size = picture->size();
  std::set<std::string> dictionaries = {kTableTags};
  if (known) {
    for (const Fiducial& each : known->fiducials) dictionaries.insert(each.dictionary);
  }
  if (aim.sheet) {
    for (const SheetTag& each : aim.sheet->sheet.tags) dictionaries.insert(each.dictionary);
  }
  SeenFrame seen;
  std::vector<TagSighting> tags;
  for (const std::string& dictionary : dictionaries) {
    const auto found = find_tags(grey, dictionary);
    if (!found) return found.error();
    tags.insert(tags.end(), found->begin(), found->end());
  }
  for (const TagSighting& tag : tags) {
    FramedShape& shape = seen.tags.emplace_back(FramedShape{name_of_tag(tag.dictionary, tag.id), {}});
    for (const PixelPoint& corner : tag.corners_px) shape.corners.push_back(share_of(corner, size));
  }
  if (known) {
    if (const auto off = offsets_of(tags, size, known->camera, known->fiducials)) {
      seen.off_mm = off->rms_mm;
      seen.fiducials = off->tags;
    }
  }
  if (aim.board) see_board(grey, *aim.board, seen);
  if (aim.sheet) see_sheet(std::move(tags), size, *aim.sheet, seen);
  if ((aim.board || aim.sheet) && !seen.board && !seen.sheet) {
    if (const OwnedTarget* there = target_in(grey, aim.owned))
      seen.says += fmt::format(" There is {}.", there->says);
  }
  if (!seen.tags.empty())
    seen.says += fmt::format("{}{} tags.", seen.says.empty() ? "" : " ", seen.tags.size());
  return seen;
}

Json json_of(const KnownFrame& known) {
  Json tags = Json::array();
  for (const Fiducial& each : known.fiducials) {
    FramedShape shape = {name_of_tag(each.dictionary, each.id), {}};
    for (const Vec3& corner : each.corners_mm) {
      const Vec3 p = project(known.camera, corner);
      shape.corners.push_back(share_of({p.x, p.y}, known.camera.size));
    }
    tags.push_back(json_of(shape));
  }
  return {{"width_mm", known.width_mm},
          {"height_mm", known.height_mm},
          {"light", json_of(known.light)},
          {"normal_deg", json_of(known.normal_deg)},
          {"tags", std::move(tags)}};
}

Json json_of(const SeenFrame& seen) {
  Json tags = Json::array();
  for (const FramedShape& tag : seen.tags) tags.push_back(json_of(tag));
  return {{"tags", std::move(tags)},
          {"off_mm", seen.off_mm ? Json(*seen.off_mm) : Json()},
          {"fiducials", seen.fiducials},
          {"board", seen.board ? json_of(*seen.board) : Json()},
          {"corners", seen.corners},
          {"sheet", seen.sheet ? json_of(*seen.sheet) : Json()},
          {"says", seen.says}};
}

}  // namespace weft::calibration
