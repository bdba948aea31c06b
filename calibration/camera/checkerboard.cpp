// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "calibration/camera/board_grid.h"
#include "calibration/camera/picture.h"

namespace weft::calibration {
namespace {

// Whether the square right of and below corner (i, j) is darker than the one beside it, over the whole grid:
// 1 where squares with even column plus row are black, -1 where they are white.
double parity(View<const std::uint8_t> grey, const std::vector<PixelPoint>& corners, int columns, int rows) {
  double sum = 0;
  const auto corner = [&](int i, int j) { return corners[static_cast<std::size_t>(j * columns + i)]; };
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const PixelPoint a = corner(i, j), b = corner(i + 1, j + 1);
      // Square (i + 1, j + 1) of the board lies between corners (i, j) and (i + 1, j + 1).
      const double brightness = sample(grey, (a.x + b.x) / 2, (a.y + b.y) / 2);
      sum += (i + j) % 2 == 0 ? -brightness : brightness;
    }
  }
  return sum;
}

// Corners in the order that makes the upper left square black and the board's front its front.
std::vector<PixelPoint> oriented(View<const std::uint8_t> grey, std::vector<PixelPoint> corners, int columns,
                                 int rows) {
  const auto corner = [&](int i, int j) { return corners[static_cast<std::size_t>(j * columns + i)]; };
  const PixelPoint o = corner(0, 0), x = corner(columns - 1, 0), y = corner(0, rows - 1);
  if ((x.x - o.x) * (y.y - o.y) - (x.y - o.y) * (y.x - o.x) < 0) {  // mirrored: its rows from the other end
    for (int j = 0; j < rows; ++j) {
      const auto row = corners.begin() + static_cast<std::ptrdiff_t>(j) * columns;
      std::reverse(row, row + columns);
    }
  }
  const bool one_way = (columns + rows) % 2 != 0;
  const bool turn = one_way ? parity(grey, corners, columns, rows) < 0 : corners.back().x < corners.front().x;
  if (turn) std::reverse(corners.begin(), corners.end());
  return corners;
}

// Whether the pattern goes on beyond a side of the grid: OpenCV finds a small board in a large one, too.
bool goes_on(View<const std::uint8_t> grey, Grid& grid) {
  // One step outside of a row or column that has `inner` on its other side.
  const auto beyond = [&](bool is_row, int first, int inner) {
    double sum = 0, places = 0;
    const int n = is_row ? grid.columns() : grid.rows();
    for (int k = 1; k < n; ++k) {
      const auto corner = [&](int line, int l) { return is_row ? grid(l, line) : grid(line, l); };
      const auto a = corner(first, k), b = corner(inner, k), next = corner(first, k + 1);
      if (!a || !b || !next) continue;
      const PixelPoint out = {a->x - b->x, a->y - b->y}, along = {next->x - a->x, next->y - a->y};
      const PixelPoint at = {a->x + out.x, a->y + out.y};
      const double reach = 0.5 * (std::hypot(out.x, out.y) + std::hypot(along.x, along.y));
      if (!is_inside(grey, at.x, at.y, reach)) continue;
      sum += chequer(grey, at, along, out, 0.3);
      ++places;
    }
    return places > 0 && sum > kChequer * places;
  };
  return beyond(true, 1, 2) || beyond(true, grid.rows(), grid.rows() - 1) || beyond(false, 1, 2) ||
         beyond(false, grid.columns(), grid.columns() - 1);
}

// Corners of whatever checkerboard there is, row by row.
struct AnyBoard {
  int columns = 0, rows = 0;
  std::vector<cv::Point2f> corners;
};

AnyBoard any_checkerboard(const cv::Mat& picture) {
  AnyBoard board;
  cv::Mat squares;
  if (!cv::findChessboardCornersSB(picture, {3, 3}, board.corners,
                                   cv::CALIB_CB_LARGER | cv::CALIB_CB_NORMALIZE_IMAGE, squares))
    return {};
  board.columns = squares.cols;
  board.rows = squares.rows;
  return board;
}

AnyBoard transposed(const AnyBoard& board) {
  AnyBoard out = {board.rows, board.columns, {}};
  for (int i = 0; i < board.columns; ++i) {
    for (int j = 0; j < board.rows; ++j)
      out.corners.push_back(board.corners[static_cast<std::size_t>(j * board.columns + i)]);
  }
  return out;
}

// What there is in place of the board that was asked for.
BoardSighting other_board(const AnyBoard& seen, const Board& board, cv::Size frame) {
  if (seen.corners.empty()) return faulty(BoardFault::kNotFound, "there is no checkerboard in the picture");
  double to_border = std::numeric_limits<double>::infinity();
  for (const cv::Point2f p : seen.corners) {
    const auto x = static_cast<double>(p.x), y = static_cast<double>(p.y);
    to_border = std::min({to_border, x, y, frame.width - 1 - x, frame.height - 1 - y});
  }
  const double side = cv::norm(seen.corners[1] - seen.corners[0]);
  const auto fits = [&](int columns, int rows) {
    return columns < board.squares_x && rows < board.squares_y;
  };
  const bool is_part = fits(seen.columns, seen.rows) || fits(seen.rows, seen.columns);
  return faulty(
      is_part && to_border < 1.5 * side ? BoardFault::kPartial : BoardFault::kWrongSquares,
      fmt::format("{} x {} corners were found where a board of {} x {} squares has {} x {}", seen.columns,
                  seen.rows, board.squares_x, board.squares_y, board.squares_x - 1, board.squares_y - 1));
}

}  // namespace

BoardSighting find_checkerboard(View<const std::uint8_t> grey, const Board& board,
                                const BoardLimits& limits) {
  const ReducedPicture picture = reduced(grey);
  Grid grid = {board};
  const int columns = grid.columns(), rows = grid.rows();
  std::vector<cv::Point2f> seen;
  // By OpenCV's detector of Duda and Frese (BMVC 2018): its older one misses most boards of many squares.
  // Some are found only as they are, some only with their contrast evened out.
  const auto find = [&](int flags) {
    return cv::findChessboardCornersSB(picture.picture, {columns, rows}, seen,
                                       cv::CALIB_CB_EXHAUSTIVE | flags);
  };
  if (!find(0) && !find(cv::CALIB_CB_NORMALIZE_IMAGE)) {
    AnyBoard any = any_checkerboard(picture.picture);
    if (any.columns == rows && any.rows == columns) any = transposed(any);
    if (any.columns != columns || any.rows != rows) return other_board(any, board, picture.picture.size());
    seen = std::move(any.corners);
  }
  std::vector<PixelPoint> corners;
  for (const cv::Point2f p : seen) corners.push_back(picture.whole(p));
  corners = oriented(grey, std::move(corners), columns, rows);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const PixelPoint at = corners[static_cast<std::size_t>(j * columns + i)];
      const auto side = [&](int k, int l) {  // towards a neighbour
        const PixelPoint next = corners[static_cast<std::size_t>(l * columns + k)];
        return PixelPoint{next.x - at.x, next.y - at.y};
      };
      grid(i + 1, j + 1) =
          saddle_near(grey, at, {side(i > 0 ? i - 1 : 1, j), side(i, j > 0 ? j - 1 : 1), 0.4});
    }
  }
  if (grid.found() < 4)
    return faulty(BoardFault::kTooSmall, "its squares have too few pixels to find their corners");
  if (goes_on(grey, grid)) {
    return faulty(BoardFault::kWrongSquares, fmt::format("its squares go on beyond a board of {} x {}",
                                                         board.squares_x, board.squares_y));
  }
  return judged(grey, grid, limits);
}

}  // namespace weft::calibration
