// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "calibration/camera/board_grid.h"
#include "calibration/camera/dictionary.h"
#include "calibration/camera/picture.h"

namespace weft::calibration {
namespace {

constexpr double kAgrees = 0.15;  // of a square: a marker this far off its place is of another board

struct SeenMarker {
  int id;                             // from the board's first
  std::array<PixelPoint, 4> corners;  // upper left first, clockwise
};

std::vector<SeenMarker> detect(const ReducedPicture& picture,
                               const cv::Ptr<cv::aruco::Dictionary>& dictionary, int first_marker) {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(picture.picture, dictionary, corners, ids);
  std::vector<SeenMarker> markers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    SeenMarker marker = {ids[i] - first_marker, {}};
    for (std::size_t k = 0; k < 4; ++k) marker.corners[k] = picture.whole(corners[i][k]);
    markers.push_back(marker);
  }
  return markers;
}

// Column and row of the square that holds each marker: the white ones, row by row from the top. In the old
// pattern the square at the upper left is white.
std::vector<std::array<int, 2>> marker_squares(const Board& board, bool is_old) {
  std::vector<std::array<int, 2>> squares;
  for (int row = 0; row < board.squares_y; ++row) {
    const int first = is_old ? row % 2 : 1 - row % 2;
    for (int column = first; column < board.squares_x; column += 2) squares.push_back({column, row});
  }
  return squares;
}

// Corners of a marker in squares from the board's upper left, y down.
std::array<cv::Point2d, 4> marker_places(const Board& board, std::array<int, 2> square) {
  const double near = (1 - board.marker_share) / 2, far = 1 - near;
  const double x = square[0], y = square[1];
  return {{{x + near, y + near}, {x + far, y + near}, {x + far, y + far}, {x + near, y + far}}};
}

// From squares to pixels, by these markers; empty where they do not determine it. `inliers` counts markers
// that lie where the board has them.
cv::Mat homography_of(const Board& board, const std::vector<std::array<int, 2>>& squares,
                      const std::vector<SeenMarker>& markers, bool robust, int* inliers = nullptr) {
  std::vector<cv::Point2d> places, seen;
  for (const SeenMarker& marker : markers) {
    const auto at = marker_places(board, squares[static_cast<std::size_t>(marker.id)]);
    for (std::size_t k = 0; k < 4; ++k) {
      places.push_back(at[k]);
      seen.emplace_back(marker.corners[k].x, marker.corners[k].y);
    }
  }
  if (places.size() < 4) return {};
  double side = 0;
  for (const SeenMarker& marker : markers) side += distance(marker.corners[0], marker.corners[1]);
  side /= static_cast<double>(markers.size()) * board.marker_share;
  cv::Mat mask;
  const cv::Mat homography = cv::findHomography(places, seen, robust ? cv::RANSAC : 0,
                                                std::max(2.0, kAgrees * side), mask, 2000, 0.999);
  if (inliers != nullptr) *inliers = homography.empty() ? 0 : cv::countNonZero(mask) / 4;
  return homography;
}

// Markers that go on with the board's pattern beyond its sides: it has more squares than were named.
int beyond_the_board(const Board& board, bool is_old, const cv::Mat& homography,
                     const std::vector<SeenMarker>& others) {
  int beyond = 0;
  for (const SeenMarker& marker : others) {
    PixelPoint centre;
    for (const PixelPoint& p : marker.corners) centre = {centre.x + p.x / 4, centre.y + p.y / 4};
    const PixelPoint square = through(homography.inv(), centre.x, centre.y);
    const double column = std::floor(square.x), row = std::floor(square.y);
    const bool in_a_white_square = std::abs(square.x - column - 0.5) < kAgrees &&
                                   std::abs(square.y - row - 0.5) < kAgrees &&
                                   (std::fmod(column + row, 2) != 0) != is_old;
    const bool beside = column >= -1 && row >= -1 && column <= board.squares_x && row <= board.squares_y;
    if (in_a_white_square && beside) ++beyond;
  }
  return beyond;
}

// Each inner corner lies between two markers on a diagonal; it is looked for where those that were read say.
Grid charuco_corners(View<const std::uint8_t> grey, const Board& board,
                     const std::vector<std::array<int, 2>>& squares, const std::vector<SeenMarker>& markers) {
  std::map<std::array<int, 2>, const SeenMarker*> at;
  for (const SeenMarker& marker : markers) at[squares[static_cast<std::size_t>(marker.id)]] = &marker;
  Grid grid = {board};
  constexpr double kNearby = 0.1;  // of a square
  for (int j = 1; j <= grid.rows(); ++j) {
    for (int i = 1; i <= grid.columns(); ++i) {
      std::vector<SeenMarker> beside;
      for (const std::array<int, 2> square : {std::array{i - 1, j - 1}, {i, j - 1}, {i - 1, j}, {i, j}}) {
        if (const auto marker = at.find(square); marker != at.end()) beside.push_back(*marker->second);
      }
      const cv::Mat homography = homography_of(board, squares, beside, false);
      if (homography.empty()) continue;
      const PixelPoint rough = through(homography, i, j);
      const auto side = [&](double x, double y) {
        const PixelPoint p = through(homography, i + x, j + y);
        return PixelPoint{(p.x - rough.x) / kNearby, (p.y - rough.y) / kNearby};
      };
      grid(i, j) =
          saddle_near(grey, rough, {side(kNearby, 0), side(0, kNearby), (1 - board.marker_share) / 2});
    }
  }
  return grid;
}

BoardSighting find_pattern(View<const std::uint8_t> grey, const Board& board, const BoardLimits& limits,
                           bool is_old) {
  const auto dictionary = *find_dictionary(board.dictionary);
  const auto squares = marker_squares(board, is_old);
  const ReducedPicture picture = reduced(grey);
  std::vector<SeenMarker> markers = detect(picture, dictionary, board.first_marker), others;
  if (markers.size() < 4) {
    ReducedPicture turned = picture;
    cv::flip(picture.picture, turned.picture, 1);
    const std::size_t seen_from_behind = detect(turned, dictionary, board.first_marker).size();
    if (seen_from_behind >= 4) {
      return faulty(BoardFault::kMirrored,
                    fmt::format("{} of its markers can be read as in a mirror, {} as printed",
                                seen_from_behind, markers.size()));
    }
    return faulty(BoardFault::kNotFound,
                  fmt::format("{} of its {} markers can be read", markers.size(), squares.size()));
  }
  const auto is_known = [&](const SeenMarker& m) {
    return m.id >= 0 && m.id < static_cast<int>(squares.size());
  };
  const auto end = std::stable_partition(markers.begin(), markers.end(), is_known);
  others.assign(end, markers.end());
  markers.erase(end, markers.end());

  int inliers = 0;
  const cv::Mat homography = homography_of(board, squares, markers, true, &inliers);
  if (homography.empty() || inliers < 0.8 * static_cast<double>(markers.size())) {
    return faulty(
        BoardFault::kWrongSquares,
        fmt::format("{} markers were read, and {} of them lie where a board of {} x {} squares has them",
                    markers.size() + others.size(), inliers, board.squares_x, board.squares_y));
  }
  if (const int beyond = beyond_the_board(board, is_old, homography, others); beyond > 0) {
    return faulty(BoardFault::kWrongSquares, fmt::format("{} markers go on beyond a board of {} x {} squares",
                                                         beyond, board.squares_x, board.squares_y));
  }
  Grid grid = charuco_corners(grey, board, squares, markers);
  if (grid.found() < 4) {
    const double side = distance(markers[0].corners[0], markers[0].corners[1]);
    return faulty(BoardFault::kTooSmall,
                  fmt::format("a marker has {:.0f} pixels a side: too few to find corners "
                              "beside it",
                              side));
  }
  BoardSighting sighting = judged(grey, grid, limits);
  sighting.old_pattern = is_old;
  return sighting;
}

}  // namespace

// Ids tell the two patterns of an even number of rows apart: by the other one a board is never whole.
BoardSighting find_charuco(View<const std::uint8_t> grey, const Board& board, const BoardLimits& limits) {
  BoardSighting sighting = find_pattern(grey, board, limits, false);
  const bool is_whole = sighting.corners.size() == static_cast<std::size_t>(board.corners());
  const bool may_be_old = sighting.fault == BoardFault::kNone ||
                          sighting.fault == BoardFault::kWrongSquares ||
                          sighting.fault == BoardFault::kPartial;
  if (is_whole || !may_be_old || board.squares_y % 2 != 0) return sighting;
  BoardSighting old = find_pattern(grey, board, limits, true);
  const bool is_more = sighting.fault != BoardFault::kNone || old.corners.size() > sighting.corners.size();
  return old.fault == BoardFault::kNone && is_more ? old : sighting;
}

}  // namespace weft::calibration
