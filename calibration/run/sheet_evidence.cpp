// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/sheet_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "calibration/lights/sheet_blocks.h"
#include "calibration/run/rig_evidence.h"
#include "core/base/files.h"
#include "core/base/parallel.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Averages of one photograph, a band of squares in memory at a time.
SheetBlockGrid blocks_of(const solve::Photographs& photographs, std::size_t k, int square_px) {
  SheetBlockGrid grid(photographs.size, square_px);
  const solve::Planes planes = photographs.planes();
  Image<float> scratch({photographs.size.width, square_px});
  for (int row = 0; row < grid.rows; ++row) {
    const Rect rows = {0, row * square_px, photographs.size.width, (row + 1) * square_px};
    const std::vector<View<const float>> readings = readings_of(photographs.frames, k, rows, scratch.plane());
    if (planes.count == 1) {
      average_row(grid, row, readings[0], planes.cfa);
    } else {
      average_row(grid, row, {readings[0], readings[1], readings[2]});
    }
  }
  return grid;
}

double normal_sigma_deg(const SheetPose& pose) {
  return degrees(std::sqrt(pose.covariance[0] + pose.covariance[7]));
}

}  // namespace

Result<SheetEvidence> sheet_evidence(const Calibration& calibration, const solve::Photographs& photographs,
                                     const TaggedSheet& sheet, int square_px, const std::string& where,
                                     const JobContext& context) {
  const CameraModel& camera = *calibration.camera;
  std::set<std::string> dictionaries;
  for (const SheetTag& tag : sheet.tags) dictionaries.insert(tag.dictionary);
  const auto tags = tags_in(photographs, {dictionaries.begin(), dictionaries.end()});
  if (!tags) return tags.error();
  const auto pose = sheet_pose(camera, *tags, sheet.tags, where);
  if (!pose) return pose.error();

  SheetEvidence evidence;
  evidence.rig_from_sheet = pose->rig_from_sheet;
  evidence.normal_sigma_deg = normal_sigma_deg(*pose);
  const SheetBlockGrid places(photographs.size, square_px);
  evidence.columns = places.columns;
  evidence.rows = places.rows;
  const std::size_t leds = light_count(*calibration.lights);
  for (int row = 0; row < places.rows; ++row) {
    for (int column = 0; column < places.columns; ++column) {
      const double x = places.centre_px(column), y = places.centre_px(row);
      if (!shows_paper(camera, sheet.sheet, evidence.rig_from_sheet, x, y, square_px)) continue;
      SheetSquare& square = evidence.squares.emplace_back(SheetSquare{column, row, x, y, {}});
      square.reading_rgb.assign(leds, {kNaN, kNaN, kNaN});
    }
  }
  if (evidence.squares.empty()) {
    return Error{ErrorKind::kBadData, "no square shows paper alone", where,
                 "the sheet fills too little of the frame for squares of this size",
                 "show a larger sheet, or take smaller squares"};
  }
  parallel_for(photographs.count(), context.threads, [&](std::size_t k, int) {
    const SheetBlockGrid grid = blocks_of(photographs, k, square_px);
    const auto led = static_cast<std::size_t>(photographs.leds[k] - 1);
    for (SheetSquare& square : evidence.squares) {
      for (int c = 0; c < 3; ++c)
        square.reading_rgb[led][static_cast<std::size_t>(c)] = grid.at(square.column, square.row, c).reading;
    }
  });
  return evidence;
}

std::vector<LitPlace> places_of(const SheetEvidence& sheet, const CameraModel& camera) {
  std::vector<LitPlace> places;
  for (const SheetSquare& square : sheet.squares) {
    const auto point = point_on_sheet(sight_of(camera, square.x_px, square.y_px), sheet.rig_from_sheet);
    if (!point) continue;
    LitPlace& place = places.emplace_back();
    place.point_mm = *point;
    place.normal = normal_of(sheet.rig_from_sheet);
    place.on_table = false;
    place.x_px = square.x_px, place.y_px = square.y_px;
    place.surface = 0;
    place.reflectance_sigma = 1;
    place.reading_rgb = square.reading_rgb;
  }
  return places;
}

fs::path in_or_beside(const fs::path& folder, const char* name) {
  if (is_there(folder / name)) return folder / name;
  return absolute_folder(folder).parent_path() / name;
}

}  // namespace weft::calibration
