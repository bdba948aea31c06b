// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>
#include <utility>

#include "calibration/run/board_photographs.h"
#include "calibration/run/sheet_files.h"
#include "core/base/files.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

Error bad_key(const fs::path& file, const std::string& key, std::string why) {
  return {ErrorKind::kBadData, "the board's description cannot be used",
          fmt::format("{}: {}", file.string(), key), std::move(why),
          "see docs/calibration.md for the keys of board.toml"};
}

void describe_board(Fields& fields, BoardSettings& b, const char* kind) {
  fields.value({.name = kind,
                .says = "What is printed; default that of board.toml",
                .words = {"charuco", "checkerboard"}},
               b.kind);
  fields.value({"squares_x", "Squares a row", kBoardSquares}, b.squares_x);
  fields.value({"squares_y", "Squares a column", kBoardSquares}, b.squares_y);
  fields.value({.name = "square_mm",
                .says = "Side of a square, mm",
                .range = kBoardSquare_mm,
                .option = "--square-mm"},
               b.square_mm);
  fields.value({"marker_share", "ChArUco: side of a marker over that of a square", kMarkerShare},
               b.marker_share);
  fields.value({"dictionary", "ChArUco: as OpenCV names it, DICT_5X5_100"}, b.dictionary);
  fields.value({"first_marker", "ChArUco: number of its first marker in the dictionary, 0", {0, 999}},
               b.first_marker);
  fields.value({.name = "thickness_mm",
                .says = "Of the board: the table is so far below its print",
                .range = kBoardThickness_mm,
                .option = "--thickness-mm"},
               b.thickness_mm);
}

/// What the file says, where the options say nothing.
Result<BoardSettings> settings_of(const fs::path& file, const BoardSettings& options) {
  if (!is_there(file)) return options;
  Result<BoardDescription> said = read_file<BoardDescription>(file, kCalibrationPage);
  if (!said) return std::move(said).error();
  const auto over = [](const auto& by_option, auto& in_file) {
    if (by_option) in_file = by_option;
  };
  over(options.kind, said->kind);
  over(options.squares_x, said->squares_x);
  over(options.squares_y, said->squares_y);
  over(options.square_mm, said->square_mm);
  over(options.marker_share, said->marker_share);
  over(options.dictionary, said->dictionary);
  over(options.first_marker, said->first_marker);
  over(options.thickness_mm, said->thickness_mm);
  return BoardSettings(*said);
}

}  // namespace

void describe(Fields& fields, BoardSettings& settings) {
  describe_board(fields, settings, "board");
}

void describe(Fields& fields, BoardDescription& board) {
  describe_board(fields, board, "kind");
}

Result<PrintedBoard> read_board_file(const fs::path& file, const BoardSettings& options) {
  const Result<BoardSettings> said = settings_of(file, options);
  if (!said) return said.error();
  PrintedBoard out;
  Board& board = out.board;
  board.kind = said->kind.value_or("charuco") == "charuco" ? BoardKind::kCharuco : BoardKind::kCheckerboard;
  if (!said->squares_x) return bad_key(file, "squares_x", "it is missing");
  if (!said->squares_y) return bad_key(file, "squares_y", "it is missing");
  if (!said->square_mm) return bad_key(file, "square_mm", "it is missing");
  board.squares_x = *said->squares_x;
  board.squares_y = *said->squares_y;
  board.square_mm = *said->square_mm;
  board.marker_share = said->marker_share.value_or(board.marker_share);
  board.dictionary = said->dictionary.value_or(board.dictionary);
  board.first_marker = said->first_marker.value_or(board.first_marker);
  out.thickness_mm = said->thickness_mm.value_or(0);
  if (const Result<void> ok = check_board(board); !ok) return ok.error();
  return out;
}

}  // namespace weft::calibration
