// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/pose_words.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace weft::calibration {
namespace {

constexpr double kLifted_mm = 5;
constexpr double kBeside = 0.08;  // of the frame: less is the middle

PixelPoint centre_of(const BoardPose& pose) {
  PixelPoint centre;
  for (const PixelPoint& p : pose.outline_px) centre.x += p.x / 4, centre.y += p.y / 4;
  return centre;
}

/// The part of the frame, "in the middle", "at the upper left".
std::string place_of(PixelPoint p, Size size) {
  const double x = p.x / size.width - 0.5, y = p.y / size.height - 0.5;
  const char* column = x < -kBeside ? "left" : x > kBeside ? "right" : "";
  const char* row = y < -kBeside ? "upper" : y > kBeside ? "lower" : "";
  if (*column == 0 && *row == 0) return "in the middle";
  if (*column == 0) return fmt::format("{} the middle", *row == 'u' ? "above" : "below");
  return fmt::format("at the {}{}{}", row, *row == 0 ? "" : " ", column);
}

}  // namespace

std::string edge_towards(PixelPoint from, PixelPoint to) {
  constexpr std::array kEdges = {"right edge", "lower right corner", "lower edge", "lower left corner",
                                 "left edge",  "upper left corner",  "upper edge", "upper right corner"};
  const double turn = std::atan2(to.y - from.y, to.x - from.x) / (std::numbers::pi / 4);
  return kEdges[static_cast<std::size_t>(std::lround(turn) + 8) % 8];
}

std::string words_of(const BoardPose& pose, const CameraModel& camera) {
  const PixelPoint centre = centre_of(pose);
  std::string words = pose.tilt_deg > 0 ? fmt::format("tilt the board by {:.0f} degrees, raising its {}, ",
                                                      pose.tilt_deg, edge_towards(centre, pose.raised_px))
                                        : std::string("hold the board level, ");
  words += place_of(centre, camera.size) + " of the picture";
  if (pose.height_mm > kLifted_mm)
    words += fmt::format(", its lowest edge {:.0f} mm above the table", pose.height_mm);
  return words;
}

}  // namespace weft::calibration
