// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/aruco.hpp>
#include <optional>
#include <vector>

#include "calibration/camera/dictionary.h"
#include "calibration/camera/markers.h"
#include "calibration/camera/picture.h"

namespace weft::calibration {
namespace {

constexpr double kEnd = 0.14;  // share of an edge at each end that is not used: corners are round there
constexpr int kMostPlaces = 64;
constexpr double kStep_px = 0.5;      // of a profile across an edge
constexpr double kLeastReach_px = 2;  // of a profile to either side
constexpr double kMostReach_px = 8;
constexpr double kLeastEdgeContrast = 12;  // of 255

struct Line {
  PixelPoint at;
  double dx, dy;  // along, unit length
};

// Where brightness changes along the normal (nx, ny) of an edge, dark to bright, as an offset from `at`: the
// centroid of its rise. Nothing where there is no such rise within `reach`.
std::optional<double> edge_offset(View<const std::uint8_t> grey, PixelPoint at, double nx, double ny,
                                  double reach) {
  if (!is_inside(grey, at.x, at.y, reach + 2)) return std::nullopt;
  const int half = static_cast<int>(reach / kStep_px);
  std::vector<double> rise;
  double most = 0;
  for (int i = -half; i <= half; ++i) {
    const auto value = [&](double t) { return sample(grey, at.x + t * nx, at.y + t * ny); };
    rise.push_back(value((i + 1) * kStep_px) - value((i - 1) * kStep_px));
    most = std::max(most, rise.back());
  }
  double sum = 0, moment = 0;
  for (int i = -half; i <= half; ++i) {
    const double r = rise[static_cast<std::size_t>(i + half)] - 0.2 * most;
    if (r <= 0) continue;
    sum += r;
    moment += r * i * kStep_px;
  }
  if (most < kLeastEdgeContrast * kStep_px || sum <= 0) return std::nullopt;
  return moment / sum;
}

// A line through the edge of a tag near a b, whose inside is to the right of a to b as seen in the picture
// (clockwise corners, y down).
std::optional<Line> edge_line(View<const std::uint8_t> grey, PixelPoint a, PixelPoint b, double reach) {
  const double side = distance(a, b);
  const double dx = (b.x - a.x) / side, dy = (b.y - a.y) / side;
  const double nx = dy, ny = -dx;  // outwards, where the margin is white
  std::vector<double> along, offset;
  const int places = std::min(static_cast<int>(side * (1 - 2 * kEnd)), kMostPlaces);
  for (int i = 0; i < places; ++i) {
    const double s = side * (kEnd + (1 - 2 * kEnd) * (i + 0.5) / places);
    const auto t = edge_offset(grey, {a.x + s * dx, a.y + s * dy}, nx, ny, reach);
    if (!t) continue;
    along.push_back(s);
    offset.push_back(*t);
  }
  if (along.size() < 4 || 2 * along.size() < static_cast<std::size_t>(places)) return std::nullopt;

  // offset = c + m s by least squares, once more without what lies far off.
  double c = 0, m = 0, limit = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 2; ++round) {
    double n = 0, s1 = 0, s2 = 0, t1 = 0, st = 0, left = 0;
    for (std::size_t i = 0; i < along.size(); ++i) {
      if (std::abs(offset[i] - c - m * along[i]) > limit) continue;
      n += 1, s1 += along[i], s2 += along[i] * along[i], t1 += offset[i], st += along[i] * offset[i];
    }
    m = (n * st - s1 * t1) / (n * s2 - s1 * s1);
    c = (t1 - m * s1) / n;
    for (std::size_t i = 0; i < along.size(); ++i) left += std::pow(offset[i] - c - m * along[i], 2);
    limit = 2.5 * std::sqrt(left / n) + 1e-6;
  }
  const double turn = 1 / std::hypot(1.0, m);
  return Line{{a.x + c * nx, a.y + c * ny}, turn * (dx + m * nx), turn * (dy + m * ny)};
}

std::optional<PixelPoint> meeting(const Line& a, const Line& b) {
  const double det = a.dx * b.dy - a.dy * b.dx;
  if (std::abs(det) < 0.2) return std::nullopt;
  const double s = ((b.at.x - a.at.x) * b.dy - (b.at.y - a.at.y) * b.dx) / det;
  return PixelPoint{a.at.x + s * a.dx, a.at.y + s * a.dy};
}

using Corners = std::array<PixelPoint, 4>;

// The corners where the edges meet, from corners a few pixels off. A profile reaches no further than to the
// first cell on the inside.
std::optional<Corners> refined(View<const std::uint8_t> grey, Corners corners, int cells) {
  for (int round = 0; round < 3; ++round) {
    double side = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 4; ++i) side = std::min(side, distance(corners[i], corners[(i + 1) % 4]));
    const double cell = side / cells;
    const double reach =
        std::clamp(0.7 * cell, kLeastReach_px, round == 0 ? 0.7 * cell + kLeastReach_px : kMostReach_px);
    std::array<std::optional<Line>, 4> lines;
    for (std::size_t i = 0; i < 4; ++i) {
      lines[i] = edge_line(grey, corners[i], corners[(i + 1) % 4], reach);
      if (!lines[i]) return std::nullopt;
    }
    Corners next;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto corner = meeting(*lines[(i + 3) % 4], *lines[i]);
      if (!corner || distance(*corner, corners[i]) > cell) return std::nullopt;
      next[i] = *corner;
    }
    corners = next;
  }
  return corners;
}

}  // namespace

Result<std::vector<TagSighting>> find_tags(View<const std::uint8_t> grey, const std::string& dictionary) {
  const auto known = find_dictionary(dictionary);
  if (!known) return known.error();
  if (std::min(grey.width(), grey.height()) < kLeastSide) return std::vector<TagSighting>();
  const ReducedPicture picture = reduced(grey);
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(picture.picture, *known, corners, ids);

  std::vector<TagSighting> found;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Corners rough;
    for (std::size_t k = 0; k < 4; ++k) rough[k] = picture.whole(corners[i][k]);
    const auto fine = refined(grey, rough, (*known)->markerSize + 2);
    if (fine) found.push_back({dictionary, ids[i], *fine});
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return found;
}

}  // namespace weft::calibration
