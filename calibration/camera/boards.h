// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "calibration/camera/pose.h"
#include "core/base/number.h"
#include "core/base/result.h"
#include "core/image/image.h"

// Checkerboards and ChArUco boards in photographs.

namespace weft::calibration {

enum class BoardKind { kCheckerboard, kCharuco };

inline constexpr NumberRange kBoardSquares = {3, 100}, kBoardSquare_mm = {1e-3, 1e4},
                             kMarkerShare = {0.3, 0.9};

/// A board as it is printed: the square at the upper left is black; a ChArUco board has markers in its white
/// squares, row by row, as OpenCV 4.6 draws it. Before 4.6 a board of even rows began with a white square: it
/// is known by its ids.
struct Board {
  BoardKind kind = BoardKind::kCharuco;
  int squares_x = 0, squares_y = 0;  ///< kBoardSquares; of a checkerboard 4 at least, and not both alike
  double square_mm = 0;              ///< kBoardSquare_mm
  double marker_share = 0.75;        ///< side of a marker over that of a square; kMarkerShare
  std::string dictionary = "DICT_5X5_100";
  int first_marker = 0;  ///< of the dictionary; those after it follow
  double stretch = 1;  ///< of the print: a square's height over its width, whose geometric mean is square_mm

  int markers() const { return squares_x * squares_y / 2; }
  int corners() const { return (squares_x - 1) * (squares_y - 1); }
  double width_mm() const { return square_mm / std::sqrt(stretch); }   ///< of a square
  double height_mm() const { return square_mm * std::sqrt(stretch); }  ///< of a square
};

/// kUsage names a setting that is out of its range, kBadData a dictionary that does not exist or is too
/// small.
Result<void> check_board(const Board& board);

/// A place where four squares meet.
struct BoardCorner {
  double u_mm = 0, v_mm = 0;  ///< u right and v up on the upright board, from its centre
  PixelPoint px;
};

/// Why a photograph is of no use.
enum class BoardFault {
  kNone,
  kNotFound,      ///< no board in the picture
  kPartial,       ///< part of it is outside the frame, covered or cannot be read
  kMirrored,      ///< markers can be read from the back, as in a mirror or through the sheet
  kWrongSquares,  ///< a board, but not of this many squares
  kTooSmall,      ///< squares of too few pixels
  kBlurred,       ///< edges too wide
};
/// "partial", as people call it.
const char* name_of(BoardFault fault);

/// What a photograph shows of a board.
struct BoardSighting {
  BoardFault fault = BoardFault::kNone;
  std::string why;  ///< with numbers; empty without fault
  std::vector<BoardCorner>
      corners;               ///< row by row from the upper left; all that were found, also with a fault
  double edge_px = 0;        ///< width of edges: contrast over steepest slope, median of the blurrier
                             ///< direction; a sharp lens behind grey_picture gives 2 to 3
  bool old_pattern = false;  ///< a ChArUco board as it was drawn before OpenCV 4.6
};

struct BoardLimits {
  double most_edge_px = 5;          ///< kBlurred above
  double least_corner_share = 0.9;  ///< of all inner corners; kPartial below
};

/// Finds a board. Corners are saddle points refined by cv::cornerSubPix in windows that hold nothing else, so
/// that they need no correction: OpenCV's interpolateCornersCharuco gives them half a pixel lower and further
/// right, as it counts from the corner of the first pixel. They start from the homographies of the markers
/// beside them, which a lens bends little; on a checkerboard from their neighbours, and rims of black or of
/// cut squares are left out. A checkerboard is turned so that its upper left square is black; where that
/// leaves two ways, so that its rows run to the right in the picture. It has no mirror image of its own: only
/// ChArUco boards can be kMirrored. `board` must pass check_board.
BoardSighting find_board(View<const std::uint8_t> grey, const Board& board, const BoardLimits& limits = {});

}  // namespace weft::calibration
