// SPDX-License-Identifier: Apache-2.0
#include "simulator/captures_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/light/incidence.h"
#include "simulator/sampling/random.h"
#include "simulator/targets/target.h"

namespace weft::simulator {
namespace {

constexpr double kBoardShare = 0.55;  // of the frame's width
constexpr int kBoardColumns = 18, kBoardRows = 12;
constexpr double kLeastSquare_px = 32;
constexpr double kTagShare = 0.05;   // of the frame's width
constexpr double kLeastTag_px = 40;  // which has 10 cells
constexpr double kMostTagShare = 0.12;
constexpr double kTagBorder = 0.2;     // white around a tag, in sides of a tag
constexpr double kInsideFrame = 0.01;  // of the frame's width stays free
constexpr double kInk_mm = 0.02;       // what is printed lies over its paper, so that the ray meets it first
constexpr int kFirstSheetTag = 10;     // the table's tags have the numbers below

double frame_width_mm(const Scene& scene) {
  return scene.camera.width * scene.camera.mm_per_pixel;
}
double frame_height_mm(const Scene& scene) {
  return scene.camera.height * scene.camera.mm_per_pixel;
}
double rounded(double mm) {
  return std::round(10 * mm) / 10;
}
double tag_side_mm(const Scene& scene) {
  const double width_px = scene.camera.width;
  const double side_px = std::clamp(kLeastTag_px, kTagShare * width_px, kMostTagShare * width_px);
  return rounded(side_px * scene.camera.mm_per_pixel);
}

/// The point of the table in the middle of the picture.
Vec3 seen_centre(const Scene& scene) {
  return {scene.camera.pose.x_mm, scene.camera.pose.y_mm, 0};
}

/// A target as an area: only its place and its size are looked at.
Target plain(const TargetSettings& settings) {
  return *Target::make(settings, 0, 0);
}

/// Points over a target, its corners among them.
std::vector<Vec3> points_of(const TargetSettings& settings) {
  const Target target = plain(settings);
  std::vector<Vec3> points;
  for (const double v : {-0.5, 0.0, 0.5}) {
    for (const double u : {-0.5, 0.0, 0.5})
      points.push_back(target.place_mm(u * target.width_mm(), v * target.height_mm()));
  }
  return points;
}

bool is_in_frame(const CameraModel& camera, const std::vector<Vec3>& points) {
  const double free_px = kInsideFrame * camera.size.width;
  return std::all_of(points.begin(), points.end(), [&](Vec3 point) {
    const Vec3 p = project(camera, point);
    return p.z > 0 && p.x >= free_px && p.y >= free_px && p.x <= camera.size.width - 1 - free_px &&
           p.y <= camera.size.height - 1 - free_px;
  });
}

TargetSettings paper_at(const SheetLayout& sheet, const CapturePose& pose, const TargetSettings& paper) {
  TargetSettings target = paper;
  target.pattern = PaperSettings{sheet.width_mm, sheet.height_mm};
  target.centre_mm = {sheet.x_mm, sheet.y_mm, 0};
  return resting(std::move(target), pose);
}

SheetLayout layout_of_width(const Scene& scene, double width_mm) {
  SheetLayout sheet;
  sheet.x_mm = scene.camera.pose.x_mm, sheet.y_mm = scene.camera.pose.y_mm;
  sheet.width_mm = rounded(width_mm);
  sheet.height_mm = rounded(width_mm * scene.camera.height / scene.camera.width);
  sheet.tag_mm = tag_side_mm(scene);
  sheet.margin_mm = rounded(sheet.tag_mm * (1 + 2 * kTagBorder) + 0.1);
  const double u = (sheet.width_mm - sheet.margin_mm) / 2, v = (sheet.height_mm - sheet.margin_mm) / 2;
  int id = kFirstSheetTag;
  for (const double along : {-u, -0.3 * sheet.height_mm, 0.3 * sheet.height_mm, u}) {
    for (const double across : {v, -v}) sheet.tags.push_back({id++, {along, across}});
  }
  return sheet;
}

}  // namespace

std::vector<CapturePose> five_poses() {
  return {{}, {20, 0}, {20, 180}, {20, 90}, {20, 270}};
}

TargetSettings resting(TargetSettings thing, const CapturePose& pose) {
  thing.tilt_deg = pose.tilt_deg;
  thing.azimuth_deg = pose.azimuth_deg;
  thing.rotation_deg = pose.rotation_deg;
  double lowest = 1e9;
  for (const Vec3 point : points_of(thing)) lowest = std::min(lowest, point.z);
  thing.centre_mm.z += pose.above_mm - lowest;
  return thing;
}

SheetLayout sheet_layout(const Scene& scene, const CameraModel& camera,
                         const std::vector<CapturePose>& poses) {
  constexpr double kStep = 0.01, kSmallest = 0.3;
  double share = 1;
  const auto fits = [&](const CapturePose& pose) {
    return is_in_frame(camera, points_of(paper_at(layout_of_width(scene, share * frame_width_mm(scene)), pose,
                                                  TargetSettings())));
  };
  while (share > kSmallest && !std::all_of(poses.begin(), poses.end(), fits)) share -= kStep;
  return layout_of_width(scene, share * frame_width_mm(scene));
}

std::vector<TargetSettings> laid(const SheetLayout& sheet, const CapturePose& pose,
                                 const TargetSettings& paper, bool sheet_first) {
  const TargetSettings lying = paper_at(sheet, pose, paper);
  const Target plane = plain(lying);
  std::vector<TargetSettings> targets;
  if (sheet_first) targets.push_back(lying);
  for (const CaptureTag& tag : sheet.tags) {
    TargetSettings& target = targets.emplace_back(lying);
    target.pattern =
        TagSettings{.id = tag.id, .side_mm = sheet.tag_mm, .margin_mm = kTagBorder * sheet.tag_mm};
    target.sheet = {};
    target.centre_mm = plane.place_mm(tag.centre_mm[0], tag.centre_mm[1]) + kInk_mm * plane.normal();
  }
  if (!sheet_first) targets.push_back(lying);
  return targets;
}

CharucoSettings board_pattern(const Scene& scene) {
  const double widest_px = kBoardShare * scene.camera.width;
  CharucoSettings board;
  board.squares_x = std::clamp(static_cast<int>(widest_px / kLeastSquare_px), 6, kBoardColumns);
  board.squares_y = board.squares_x * kBoardRows / kBoardColumns;
  board.square_mm = widest_px * scene.camera.mm_per_pixel / board.squares_x;
  board.square_mm = std::floor(100 * board.square_mm) / 100;
  board.dictionary = "DICT_5X5_250";
  board.margin_mm = rounded(board.square_mm / 4 + 0.1);
  return board;
}

std::vector<TargetSettings> board_poses(const Scene& scene, const CameraModel& camera,
                                        const CharucoSettings& board, int count, std::int64_t seed) {
  // Places, tilts and azimuths by sequences of low discrepancy (Roberts 2018: powers of the plastic number;
  // the golden angle), so that few boards are spread as well as many.
  constexpr double kPlastic1 = 0.7548776662466927, kPlastic2 = 0.5698402909980532,
                   kGolden = 0.6180339887498949;
  constexpr double kLeastTilt_deg = 8, kMostTilt_deg = 34, kMostLift = 0.1;
  constexpr double kTurns_deg[] = {0, 90, 180, 270};
  const std::array<std::uint32_t, 2> key = {static_cast<std::uint32_t>(seed), 0};
  const auto fraction = [](double x) { return x - std::floor(x); };
  const PaperSettings area = {board.squares_x * board.square_mm + 2 * board.margin_mm,
                              board.squares_y * board.square_mm + 2 * board.margin_mm};
  std::vector<TargetSettings> boards;
  for (int i = 0; i < count; ++i) {
    const auto bits = philox({static_cast<std::uint32_t>(i), 0, 0, 0}, key);
    const double n = i + 0.5 * uniform(bits[0], 0);
    TargetSettings target;
    target.pattern = area;
    target.azimuth_deg = 360 * fraction(kGolden * n);
    target.rotation_deg = kTurns_deg[i % 4] + 16 * (uniform(bits[1], 0) - 0.5);
    double tilt =
        kLeastTilt_deg + (kMostTilt_deg - kLeastTilt_deg) * fraction(i / 3.0 + 0.1 * uniform(bits[2], 0));
    double lift_mm = kMostLift * scene.camera.distance_mm * fraction(i / 4.0);
    const double x = (fraction(kPlastic1 * n) - 0.5) * frame_width_mm(scene);
    const double y = (fraction(kPlastic2 * n) - 0.5) * frame_height_mm(scene);
    // As far out as it goes; a board that does not fit at the centre lies lower and flatter.
    for (double out = 1;; out -= 0.0625) {
      if (out < 0) {
        if (tilt < 1) break;
        out = 1, tilt *= 0.8, lift_mm *= 0.5;
      }
      target.centre_mm = seen_centre(scene) + Vec3{out * x, out * y, 0};
      target = resting(target, {tilt, target.azimuth_deg, target.rotation_deg, 1 + lift_mm});
      if (is_in_frame(camera, points_of(target))) break;
    }
    target.pattern = board;
    boards.push_back(target);
  }
  return boards;
}

std::vector<TargetSettings> furniture(const Scene& scene, const CameraModel& camera) {
  std::vector<TargetSettings> all;
  bool has_tag = false;
  for (const TargetSettings& target : scene.targets) {
    const TargetKind kind = kind_of(target.pattern);
    if (kind == TargetKind::kTag || kind == TargetKind::kPaper) all.push_back(target);
    has_tag = has_tag || kind == TargetKind::kTag;
  }
  if (has_tag) return all;
  const double side_mm = tag_side_mm(scene);
  int id = 0;
  for (const double y : {1.0, -1.0}) {
    for (const double x : {-1.0, 1.0}) {
      TargetSettings& tag = all.emplace_back();
      tag.pattern = TagSettings{.id = id++, .side_mm = side_mm, .margin_mm = kTagBorder * side_mm};
      for (double out = 0.5; out > 0; out -= 0.01) {
        tag.centre_mm = {out * x * frame_width_mm(scene), out * y * frame_height_mm(scene), 0.3};
        if (is_in_frame(camera, points_of(tag))) break;
      }
    }
  }
  return all;
}

double exposure_for(const Scene& scene, const SceneRig& rig, const std::vector<TargetSettings>& targets,
                    const std::vector<int>& leds, double share) {
  double brightest = 0;
  for (const TargetSettings& target : targets) {
    const Vec3 normal = plain(target).normal();
    for (const Vec3 point : points_of(target)) {
      Rgb reading{};
      for (const int number : leds) {
        const NearLight& led = rig.leds.leds[static_cast<std::size_t>(number - 1)];
        const double light = target.white * shading(incidence(led, point), normal);
        for (std::size_t c = 0; c < 3; ++c) reading[c] += light * led.flux_rgb[c];
      }
      brightest = std::max({brightest, reading[0], reading[1], reading[2]});
    }
  }
  return std::round(share * 1e6 / (brightest * scene.camera.iso / 100));
}

}  // namespace weft::simulator
