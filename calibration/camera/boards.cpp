// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/boards.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "calibration/camera/board_grid.h"
#include "calibration/camera/dictionary.h"
#include "calibration/camera/picture.h"

namespace weft::calibration {
namespace {

// Width of the sharpest edges of a picture with bright and dark in it, of those across rows and those across
// columns the blurrier: contrast of the picture over a slope that one pixel in 2000 exceeds. 0 where there is
// little contrast and nothing can be said.
double sharpest_edge(View<const std::uint8_t> grey) {
  using Counts = std::array<std::int64_t, 256>;
  Counts levels = {}, across = {}, down = {};
  for (int y = 0; y + 2 < grey.height(); ++y) {
    for (int x = 0; x + 2 < grey.width(); ++x) {
      ++levels[grey(x, y)];
      ++across[static_cast<std::size_t>(std::abs(grey(x + 2, y) - grey(x, y)))];
      ++down[static_cast<std::size_t>(std::abs(grey(x, y + 2) - grey(x, y)))];
    }
  }
  const auto quantile = [](const Counts& counts, double share) {
    const double wanted =
        share * static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
    double below = 0;
    std::size_t level = 0;
    while (level < 255 && (below += static_cast<double>(counts[level])) < wanted) ++level;
    return static_cast<double>(level);
  };
  const double dark = quantile(levels, 0.01), bright = quantile(levels, 0.99);
  const double slope = std::min(quantile(across, 0.9995), quantile(down, 0.9995)) / 2;
  return bright - dark < 0.75 * bright || slope <= 0 ? 0 : (bright - dark) / slope;
}

}  // namespace

const char* name_of(BoardFault fault) {
  switch (fault) {
    case BoardFault::kNone:
      return "good";
    case BoardFault::kNotFound:
      return "no board found";
    case BoardFault::kPartial:
      return "partial";
    case BoardFault::kMirrored:
      return "mirrored";
    case BoardFault::kWrongSquares:
      return "wrong number of squares";
    case BoardFault::kTooSmall:
      return "too small";
    case BoardFault::kBlurred:
      return "blurred";
  }
  return "";
}

Result<void> check_board(const Board& board) {
  const auto refused = [](const char* name, std::string rule) {
    return Error{ErrorKind::kUsage, "board cannot be used", name, std::move(rule),
                 "say how the board was printed"};
  };
  struct Said {
    const char* name;
    double value;
    NumberRange range;
  };
  for (const Said& said : {Said{"squares_x", static_cast<double>(board.squares_x), kBoardSquares},
                           Said{"squares_y", static_cast<double>(board.squares_y), kBoardSquares},
                           Said{"square_mm", board.square_mm, kBoardSquare_mm}}) {
    if (!said.range.holds(said.value))
      return refused(said.name, fmt::format("it must be {:g} to {:g}", said.range.least, said.range.most));
  }
  if (board.kind == BoardKind::kCheckerboard) {
    if (board.squares_x < 4 || board.squares_y < 4)
      return refused("squares_x and squares_y", "a checkerboard needs 4 squares a side");
    if (board.squares_x == board.squares_y) {
      return refused("squares_x and squares_y",
                     "a checkerboard of as many rows as columns does not say which way is up");
    }
    return {};
  }
  if (!kMarkerShare.holds(board.marker_share))
    return refused("marker_share",
                   fmt::format("it must be {:g} to {:g}", kMarkerShare.least, kMarkerShare.most));
  const auto dictionary = find_dictionary(board.dictionary);
  if (!dictionary) return dictionary.error();
  if (board.first_marker + board.markers() > (*dictionary)->bytesList.rows) {
    return Error{ErrorKind::kBadData, "the dictionary has too few markers", board.dictionary,
                 fmt::format("it has {}, and a board of {} x {} squares needs {} from {} on",
                             (*dictionary)->bytesList.rows, board.squares_x, board.squares_y, board.markers(),
                             board.first_marker),
                 "name the dictionary that the board was printed with"};
  }
  return {};
}

BoardSighting find_board(View<const std::uint8_t> grey, const Board& board, const BoardLimits& limits) {
  if (std::min(grey.width(), grey.height()) < kLeastSide)
    return faulty(BoardFault::kNotFound, "the picture is tiny");
  const BoardSighting sighting = board.kind == BoardKind::kCharuco ? find_charuco(grey, board, limits)
                                                                   : find_checkerboard(grey, board, limits);
  if (sighting.fault != BoardFault::kNotFound) return sighting;
  const double edge_px = sharpest_edge(grey);
  if (edge_px <= limits.most_edge_px) return sighting;
  return {BoardFault::kBlurred,
          fmt::format("no board can be read, and the sharpest edges are {:.1f} pixels wide", edge_px),
          {},
          edge_px};
}

}  // namespace weft::calibration
