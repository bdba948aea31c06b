// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/sets/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>
#include <variant>

#include "calibration/checks/light_at.h"
#include "core/files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using calibration::PixelPoint;

constexpr int kColumns = 12, kRows = 8;
constexpr const char* kTableTags = "DICT_APRILTAG_36h11";

Vec3 on_table(const CameraModel& camera, double x_share, double y_share) {
  return point_on_plane(camera, x_share * camera.size.width - 0.5, y_share * camera.size.height - 0.5, 0);
}

FrameGrid light_over(const CameraModel& camera, const NearLights& lights) {
  FrameGrid grid = {kColumns, kRows, {}};
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Vec3 point = on_table(camera, (column + 0.5) / kColumns, (row + 0.5) / kRows);
      double sum = 0;
      for (const NearLight& led : lights.leds) {
        const auto light = calibration::light_at(led, point);
        if (light) sum += led.flux_rgb[1] * std::exp(light->log_geometry) * std::max(light->direction.z, 0.0);
      }
      grid.values.push_back(sum);
    }
  }
  const double brightest = *std::ranges::max_element(grid.values);
  if (!(brightest > 0)) return {};
  for (double& value : grid.values) value /= brightest;
  return grid;
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

PixelPoint share_of(const PixelPoint& px, Size size) {
  return {(px.x + 0.5) / size.width, (px.y + 0.5) / size.height};
}

std::string name_of_tag(const std::string& dictionary, int id) {
  return fmt::format("{} {}", dictionary, id);
}

/// Rms distance of the corners of known tags from where the calibration has them, on the table.
void hold_against(const std::vector<calibration::TagSighting>& tags, Size size, const KnownFrame& known,
                  SeenFrame& seen) {
  double squares = 0;
  for (const calibration::TagSighting& tag : tags) {
    const auto fiducial = std::ranges::find_if(known.fiducials, [&](const Fiducial& each) {
      return each.id == tag.id && each.dictionary == tag.dictionary;
    });
    if (fiducial == known.fiducials.end()) continue;
    ++seen.fiducials;
    for (std::size_t i = 0; i < 4; ++i) {
      const PixelPoint share = share_of(tag.corners_px[i], size);
      const Vec3 expected = fiducial->corners_mm[i];
      const Vec3 there = point_on_plane(known.camera, share.x * known.camera.size.width - 0.5,
                                        share.y * known.camera.size.height - 0.5, expected.z);
      squares += dot(there - expected, there - expected);
    }
  }
  if (seen.fiducials > 0) seen.off_mm = std::sqrt(squares / (4 * seen.fiducials));
}

FramedShape outline_of(const std::vector<calibration::BoardCorner>& corners, Size size) {
  std::vector<cv::Point2f> points, hull;
  for (const calibration::BoardCorner& corner : corners)
    points.emplace_back(static_cast<float>(corner.px.x), static_cast<float>(corner.px.y));
  cv::convexHull(points, hull, /*clockwise=*/true);
  FramedShape outline = {"board", {}};
  for (const cv::Point2f& p : hull) outline.corners.push_back(share_of({p.x, p.y}, size));
  return outline;
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
  if (calibration->lights) {
    if (const auto* near = std::get_if<NearLights>(&*calibration->lights); near && !near->leds.empty())
      known.light = light_over(known.camera, *near);
  }
  known.normal_deg = predicted_by(folder);
  known.fiducials = calibration->fiducials;
  return known;
}

Result<SeenFrame> seen_frame(const std::string& jpeg, const std::optional<KnownFrame>& known,
                             const std::optional<PrintedBoard>& board) {
  const cv::Mat small =
      jpeg.empty() ? cv::Mat()
                   : cv::imdecode(cv::Mat(1, static_cast<int>(jpeg.size()), CV_8UC1,
                                          const_cast<char*>(jpeg.data())),  // NOLINT: OpenCV only reads it
                                  cv::IMREAD_GRAYSCALE);
  if (small.empty()) {
    return Error{ErrorKind::kProtocol, "the finder gave no picture", "live view", "it is no JPEG",
                 "ask for the next one"};
  }
  cv::Mat grey;  // twice as large: tags of a finder are too small to be found as they are
  cv::resize(small, grey, {}, 2, 2, cv::INTER_CUBIC);
  const Size size = {grey.cols, grey.rows};
  const View<const std::uint8_t> view(grey.data, size, static_cast<std::ptrdiff_t>(grey.step));
  std::set<std::string> dictionaries = {kTableTags};
  if (known) {
    for (const Fiducial& each : known->fiducials) dictionaries.insert(each.dictionary);
  }
  SeenFrame seen;
  std::vector<calibration::TagSighting> tags;
  for (const std::string& dictionary : dictionaries) {
    const auto found = calibration::find_tags(view, dictionary);
    if (!found) return found.error();
    tags.insert(tags.end(), found->begin(), found->end());
  }
  for (const calibration::TagSighting& tag : tags) {
    FramedShape& shape = seen.tags.emplace_back(FramedShape{name_of_tag(tag.dictionary, tag.id), {}});
    for (const PixelPoint& corner : tag.corners_px) shape.corners.push_back(share_of(corner, size));
  }
  if (known) hold_against(tags, size, *known, seen);
  if (!board) return seen;
  const calibration::BoardSighting sighting = calibration::find_board(view, board->board);
  seen.corners = static_cast<int>(sighting.corners.size());
  if (seen.corners > 2) seen.board = outline_of(sighting.corners, size);
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
          {"corners", seen.corners}};
}

}  // namespace weft::app
