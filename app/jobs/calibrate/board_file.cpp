// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>

#include "app/jobs/calibrate/board_photographs.h"
#include "core/files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

Error bad_key(const fs::path& file, const std::string& key, std::string why) {
  return {ErrorKind::kBadData, "the board's description cannot be used",
          fmt::format("{}: {}", file.string(), key), std::move(why),
          "see docs/calibration.md for the keys of board.toml"};
}

// The value of a key, if it is there and `said` holds none.
template <typename T>
Result<void> take(const toml::table& table, const fs::path& file, const char* key, std::optional<T>& said) {
  const toml::node* node = table.get(key);
  if (node == nullptr || said) return {};
  const std::optional<T> value = node->value<T>();
  if (!value) return bad_key(file, key, "its value is of the wrong kind");
  said = value;
  return {};
}

Result<void> take_all(const fs::path& file, BoardSettings& said) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  toml::table table;
  try {
    table = toml::parse(*text);
  } catch (const toml::parse_error& e) {
    return bad_key(file, fmt::format("line {}", e.source().begin.line), std::string(e.description()));
  }
  for (const auto& [key, value] : table) {
    constexpr std::array kKeys = {"kind",         "squares_x",  "squares_y",   "square_mm",
                                  "marker_share", "dictionary", "thickness_mm"};
    const std::string name(key.str());
    if (std::find(kKeys.begin(), kKeys.end(), name) == kKeys.end())
      return bad_key(file, name, "there is no such key");
  }
  for (const Result<void>& taken :
       {take(table, file, "kind", said.kind), take(table, file, "squares_x", said.squares_x),
        take(table, file, "squares_y", said.squares_y), take(table, file, "square_mm", said.square_mm),
        take(table, file, "marker_share", said.marker_share),
        take(table, file, "dictionary", said.dictionary),
        take(table, file, "thickness_mm", said.thickness_mm)}) {
    if (!taken) return taken;
  }
  return {};
}

}  // namespace

Result<PrintedBoard> read_board_file(const fs::path& file, const BoardSettings& options) {
  BoardSettings said = options;
  if (is_there(file)) {
    if (const Result<void> ok = take_all(file, said); !ok) return ok.error();
  }
  PrintedBoard out;
  calibration::Board& board = out.board;
  const std::string kind = said.kind.value_or("charuco");
  if (kind != "charuco" && kind != "checkerboard")
    return bad_key(file, "kind", fmt::format("\"{}\" is neither charuco nor checkerboard", kind));
  board.kind = kind == "charuco" ? calibration::BoardKind::kCharuco : calibration::BoardKind::kCheckerboard;
  if (!said.squares_x) return bad_key(file, "squares_x", "it is missing");
  if (!said.squares_y) return bad_key(file, "squares_y", "it is missing");
  if (!said.square_mm) return bad_key(file, "square_mm", "it is missing");
  board.squares_x = *said.squares_x;
  board.squares_y = *said.squares_y;
  board.square_mm = *said.square_mm;
  board.marker_share = said.marker_share.value_or(board.marker_share);
  board.dictionary = said.dictionary.value_or(board.dictionary);
  out.thickness_mm = said.thickness_mm.value_or(0);
  if (!kBoardThickness_mm.holds(out.thickness_mm))
    return bad_key(file, "thickness_mm",
                   fmt::format("it must be {:g} to {:g}", kBoardThickness_mm.least, kBoardThickness_mm.most));
  if (const Result<void> ok = check_board(board); !ok) return ok.error();
  return out;
}

}  // namespace weft::app
