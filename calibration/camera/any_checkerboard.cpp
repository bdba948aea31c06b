// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/any_checkerboard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "calibration/camera/board_grid.h"
#include "calibration/camera/picture.h"

namespace weft::calibration {
namespace {

constexpr double kClear = 0.4;       // of a square, around a corner
constexpr double kMost = 0.7;        // of a line of corners
constexpr double kWholeShare = 0.8;  // of a square that is no part of a rim
constexpr double kSame_px = 4;       // as far as one corner is seen twice
constexpr int kFewest = 3;           // corners along a side
constexpr int kMostSquares = 40;     // that a board is grown from

PixelPoint between(PixelPoint a, PixelPoint b) {
  return {b.x - a.x, b.y - a.y};
}

using Place = std::pair<int, int>;  // column, row
using Found = std::map<Place, PixelPoint>;

constexpr std::array<Place, 4> kAround = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

Place stepped(Place from, Place step, int times) {
  return {from.first + times * step.first, from.second + times * step.second};
}

const PixelPoint* find(const Found& found, Place at) {
  const auto it = found.find(at);
  return it == found.end() ? nullptr : &it->second;
}

// The step along a line of corners near a place.
std::optional<PixelPoint> step_near(const Found& found, Place at, Place step) {
  for (const int k : {0, -1}) {
    const PixelPoint *a = find(found, stepped(at, step, k)), *b = find(found, stepped(at, step, k + 1));
    if (a != nullptr && b != nullptr) return between(*a, *b);
  }
  return std::nullopt;
}

// The corner at `at`, which is one step beyond two that are found.
std::optional<PixelPoint> corner_beyond(View<const std::uint8_t> grey, const Found& found, Place at,
                                        Place step) {
  const PixelPoint* last = find(found, stepped(at, step, -1));
  const PixelPoint* before = find(found, stepped(at, step, -2));
  if (last == nullptr || before == nullptr) return std::nullopt;
  const std::optional<PixelPoint> across = step_near(found, stepped(at, step, -1), {step.second, step.first});
  if (!across) return std::nullopt;
  const PixelPoint along = between(*before, *last);
  return saddle_near(grey, {last->x + along.x, last->y + along.y}, {along, *across, kClear});
}

void grow(View<const std::uint8_t> grey, Found& found) {
  constexpr int kMostCorners = 20000;
  for (bool grows = true; grows && found.size() < kMostCorners;) {
    Found more;
    for (const auto& [place, corner] : found) {
      for (const Place& step : kAround) {
        const Place at = stepped(place, step, 1);
        if (found.contains(at) || more.contains(at)) continue;
        if (const auto beyond = corner_beyond(grey, found, at, step)) more.emplace(at, *beyond);
      }
    }
    grows = !more.empty();
    found.merge(more);
  }
}

struct Extent {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< both included
};

// Without lines at the sides of which less than most are found.
Extent dense(const Found& found) {
  const Place any = found.begin()->first;
  Extent e = {any.first, any.second, any.first, any.second};
  for (const auto& [place, corner] : found) {
    e.x0 = std::min(e.x0, place.first), e.x1 = std::max(e.x1, place.first);
    e.y0 = std::min(e.y0, place.second), e.y1 = std::max(e.y1, place.second);
  }
  const auto share = [&](bool is_row, int line) {
    const int from = is_row ? e.x0 : e.y0, to = is_row ? e.x1 : e.y1;
    int seen = 0;
    for (int k = from; k <= to; ++k) seen += found.contains(is_row ? Place{k, line} : Place{line, k}) ? 1 : 0;
    return static_cast<double>(seen) / (to - from + 1);
  };
  while (e.x1 > e.x0 && e.y1 > e.y0) {
    const std::array<double, 4> sides = {share(false, e.x0), share(false, e.x1), share(true, e.y0),
                                         share(true, e.y1)};
    const auto sparsest = std::ranges::min_element(sides);
    if (*sparsest >= kMost) break;
    switch (sparsest - sides.begin()) {
      case 0:
        ++e.x0;
        break;
      case 1:
        --e.x1;
        break;
      case 2:
        ++e.y0;
        break;
      default:
        --e.y1;
    }
  }
  return e;
}

// Corners that were not found are where the others say; nothing where those do not.
std::optional<CornerGrid> rectangle_of(const Found& found, const Extent& e) {
  CornerGrid grid = {e.x1 - e.x0 + 1, e.y1 - e.y0 + 1, {}};
  std::vector<cv::Point2d> places, seen;
  for (const auto& [place, corner] : found) {
    if (place.first < e.x0 || place.first > e.x1 || place.second < e.y0 || place.second > e.y1) continue;
    places.emplace_back(place.first, place.second);
    seen.emplace_back(corner.x, corner.y);
  }
  const cv::Mat homography = cv::findHomography(places, seen);
  if (homography.empty()) return std::nullopt;
  for (int j = e.y0; j <= e.y1; ++j) {
    for (int i = e.x0; i <= e.x1; ++i) {
      const PixelPoint* corner = find(found, {i, j});
      grid.corners.push_back(corner != nullptr ? *corner : through(homography, i, j));
    }
  }
  return grid;
}

// Nothing where fewer than 3 x 3 are found.
std::optional<CornerGrid> grid_of(View<const std::uint8_t> grey, Found found) {
  grow(grey, found);
  const Extent extent = dense(found);
  if (extent.x1 - extent.x0 + 1 < kFewest || extent.y1 - extent.y0 + 1 < kFewest) return std::nullopt;
  return rectangle_of(found, extent);
}

// Places in the whole picture, the sharpest first.
std::vector<PixelPoint> sharp_corners(View<const std::uint8_t> grey) {
  constexpr int kMostCorners = 4000, kApart_px = 8, kWindow_px = 5;
  constexpr double kOfTheSharpest = 0.02;
  const ReducedPicture picture = reduced(grey);
  std::vector<cv::Point2f> seen;
  cv::goodFeaturesToTrack(picture.picture, seen, kMostCorners, kOfTheSharpest, kApart_px, {}, kWindow_px);
  std::vector<PixelPoint> corners;
  for (const cv::Point2f p : seen) corners.push_back(picture.whole(p));
  return corners;
}

// The corners of one square, of which `first` is one: by the nearest to it and the nearest across that.
std::optional<Found> square_at(View<const std::uint8_t> grey, PixelPoint first,
                               const std::vector<PixelPoint>& corners) {
  constexpr double kAcross = 0.5, kLonger = 2.5;
  std::optional<PixelPoint> along, down;
  const auto length = [](PixelPoint p) { return std::hypot(p.x, p.y); };
  for (const PixelPoint& other : corners) {
    const PixelPoint side = between(first, other);
    if (length(side) > 0 && (!along || length(side) < length(*along))) along = side;
  }
  if (!along) return std::nullopt;
  for (const PixelPoint& other : corners) {
    const PixelPoint side = between(first, other);
    const double across = std::abs(along->x * side.y - along->y * side.x);
    if (across > kAcross * length(*along) * length(side) && (!down || length(side) < length(*down)))
      down = side;
  }
  if (!down || length(*down) > kLonger * length(*along)) return std::nullopt;
  Found square;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const PixelPoint rough = {first.x + i * along->x + j * down->x, first.y + i * along->y + j * down->y};
      const auto corner = saddle_near(grey, rough, {*along, *down, kClear});
      if (!corner || chequer(grey, *corner, *along, *down, 0.5) < kChequer) return std::nullopt;
      square.emplace(Place{i, j}, *corner);
    }
  }
  return square;
}

enum class Side { kWhole, kCut, kUnseen };

// Squares beyond a line of corners, seen from the line inside it.
Side side_of(View<const std::uint8_t> grey, const CornerGrid& grid, bool is_row, int line, int inside) {
  const int n = is_row ? grid.columns : grid.rows;
  const auto corner = [&](int k, int l) { return is_row ? grid.at(k, l) : grid.at(l, k); };
  int cut = 0, seen = 0;
  for (int k = 0; k + 1 < n; ++k) {
    const PixelPoint at = corner(k, line), out = between(corner(k, inside), at);
    const PixelPoint along = between(at, corner(k + 1, line));
    const double beside = kClear * std::hypot(along.x, along.y);
    if (!is_inside(grey, at.x + kWholeShare * out.x, at.y + kWholeShare * out.y, beside)) continue;
    ++seen;
    if (chequer(grey, at, {kClear / kWholeShare * along.x, kClear / kWholeShare * along.y}, out,
                kWholeShare) < kChequer)
      ++cut;
  }
  if (seen == 0) return Side::kUnseen;
  return 2 * cut > seen ? Side::kCut : Side::kWhole;
}

CornerGrid part_of(const CornerGrid& grid, const Extent& e) {
  CornerGrid part = {e.x1 - e.x0 + 1, e.y1 - e.y0 + 1, {}};
  for (int j = e.y0; j <= e.y1; ++j) {
    for (int i = e.x0; i <= e.x1; ++i) part.corners.push_back(grid.at(i, j));
  }
  return part;
}

}  // namespace

CornerGrid any_checkerboard(View<const std::uint8_t> grey) {
  const std::vector<PixelPoint> corners = sharp_corners(grey);
  CornerGrid largest;
  for (int tried = 0; const PixelPoint& corner : corners) {
    if (std::ranges::any_of(largest.corners, [&](PixelPoint p) { return distance(p, corner) < kSame_px; }))
      continue;
    std::optional<Found> square = square_at(grey, corner, corners);
    if (!square) continue;
    const std::optional<CornerGrid> grid = grid_of(grey, std::move(*square));
    if (grid && grid->corners.size() > largest.corners.size()) largest = *grid;
    if (++tried == kMostSquares) break;
  }
  return largest;
}

std::optional<CornerGrid> within_rim(View<const std::uint8_t> grey, const CornerGrid& grid, int columns,
                                     int rows) {
  const int right = grid.columns - 1, below = grid.rows - 1;
  const std::array<Side, 4> sides = {
      side_of(grey, grid, false, 0, 1), side_of(grey, grid, false, right, right - 1),
      side_of(grey, grid, true, 0, 1), side_of(grey, grid, true, below, below - 1)};
  if (std::ranges::find(sides, Side::kCut) == sides.end()) return std::nullopt;
  std::optional<CornerGrid> board;
  for (const int x0 : {0, 1}) {
    for (const int y0 : {0, 1}) {
      const Extent e = {x0, y0, x0 + columns - 1, y0 + rows - 1};
      const std::array<int, 4> lines = {x0, right - e.x1, y0, below - e.y1};  // of the rim
      bool fits = true;
      for (std::size_t side = 0; side < sides.size(); ++side) {
        fits = fits && (lines[side] == 0 ? sides[side] != Side::kCut
                                         : lines[side] == 1 && sides[side] != Side::kWhole);
      }
      if (!fits) continue;
      if (board) return std::nullopt;
      board = part_of(grid, e);
    }
  }
  return board;
}

}  // namespace weft::calibration
