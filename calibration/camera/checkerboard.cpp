// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <utility>

#include "calibration/camera/any_checkerboard.h"
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

CornerGrid transposed(const CornerGrid& grid) {
  CornerGrid out = {grid.rows, grid.columns, {}};
  for (int i = 0; i < grid.columns; ++i) {
    for (int j = 0; j < grid.rows; ++j) out.corners.push_back(grid.at(i, j));
  }
  return out;
}

// The grid, or what lies within its rim, if it has these columns and rows.
std::optional<CornerGrid> as_asked(View<const std::uint8_t> grey, const CornerGrid& seen, int columns,
                                   int rows) {
  for (const CornerGrid& grid : {seen, transposed(seen)}) {
    if (grid.columns == columns && grid.rows == rows) return grid;
    if (std::optional<CornerGrid> board = within_rim(grey, grid, columns, rows)) return board;
  }
  return std::nullopt;
}

// What there is in place of the board that was asked for.
BoardSighting other_board(const CornerGrid& seen, const Board& board, View<const std::uint8_t> grey) {
  double to_border = std::numeric_limits<double>::infinity();
  for (const PixelPoint p : seen.corners)
    to_border = std::min({to_border, p.x, p.y, grey.width() - 1 - p.x, grey.height() - 1 - p.y});
  const double side = distance(seen.corners[1], seen.corners[0]);
  const bool is_wide = board.squares_x >= board.squares_y;
  const auto [across, down] = std::minmax(
      {seen.columns, seen.rows}, [&](int one, int other) { return is_wide ? one > other : one < other; });
  const auto fits = [&](int columns, int rows) {
    return columns < board.squares_x && rows < board.squares_y;
  };
  const bool is_part = fits(seen.columns, seen.rows) || fits(seen.rows, seen.columns);
  return faulty(
      is_part && to_border < 1.5 * side ? BoardFault::kPartial : BoardFault::kWrongSquares,
      fmt::format("{} x {} corners were found where a board of {} x {} squares has {} x {}", across, down,
                  board.squares_x, board.squares_y, board.squares_x - 1, board.squares_y - 1));
}

}  // namespace

BoardSighting find_checkerboard(View<const std::uint8_t> grey, const Board& board,
                                const BoardLimits& limits) {
  Grid grid = {board};
  const int columns = grid.columns(), rows = grid.rows();
  const CornerGrid seen = any_checkerboard(grey);
  if (seen.corners.empty())
    return faulty(BoardFault::kNotFound,
                  "there is no checkerboard in the picture whose squares have 8 pixels or more");
  std::optional<CornerGrid> asked = as_asked(grey, seen, columns, rows);
  if (!asked) return other_board(seen, board, grey);
  const std::vector<PixelPoint> corners = oriented(grey, std::move(asked->corners), columns, rows);
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
  return judged(grey, grid, limits);
}

}  // namespace weft::calibration
