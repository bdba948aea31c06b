// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calibration/camera/boards.h"
#include "core/image/image.h"

// What finding a checkerboard and finding a ChArUco board share.

namespace weft::calibration {

/// Corners of a board by their place, counted in squares: corner (i, j) is i squares right of and j squares
/// below the board's upper left.
struct Grid {
  const Board& board;
  std::vector<std::optional<PixelPoint>> at =
      std::vector<std::optional<PixelPoint>>(static_cast<std::size_t>(board.corners()));

  int columns() const { return board.squares_x - 1; }
  int rows() const { return board.squares_y - 1; }
  std::optional<PixelPoint>& operator()(int i, int j) {
    return at[static_cast<std::size_t>((j - 1) * columns() + i - 1)];
  }
  bool has(int i, int j) { return i >= 1 && j >= 1 && i <= columns() && j <= rows() && (*this)(i, j); }
  int found() const {
    return static_cast<int>(std::count_if(at.begin(), at.end(), [](const auto& p) { return p.has_value(); }));
  }
};

/// Where a homography takes a point.
PixelPoint through(const cv::Mat& homography, double x, double y);

/// chequer() half way between a corner and the side of a board.
inline constexpr double kChequer = 0.75;

/// How much four squares around a place are like a chequer: 1 where they are one, 0.5 at the side of a board,
/// 0 where there is little contrast. Looks `share` of a square away along both sides of a square.
double chequer(View<const std::uint8_t> grey, PixelPoint at, PixelPoint along, PixelPoint down, double share);

/// Sides of a square in the picture, and how far it is clear around a corner.
struct Surroundings {
  PixelPoint along, down;
  double clear = 0;  ///< share of a square, along both sides
};

/// The saddle point near `rough`, in a window in which there is nothing else; nothing where there is none.
std::optional<PixelPoint> saddle_near(View<const std::uint8_t> grey, PixelPoint rough,
                                      const Surroundings& around);

BoardSighting faulty(BoardFault fault, std::string why);

/// What the corners that were found amount to.
BoardSighting judged(View<const std::uint8_t> grey, Grid& grid, const BoardLimits& limits);

BoardSighting find_charuco(View<const std::uint8_t> grey, const Board& board, const BoardLimits& limits);
BoardSighting find_checkerboard(View<const std::uint8_t> grey, const Board& board, const BoardLimits& limits);

}  // namespace weft::calibration
