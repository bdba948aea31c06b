// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/camera/boards.h"
#include "calibration/camera/markers.h"
#include "core/base/job_context.h"
#include "core/base/number.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

// A folder of photographs of a board: which can be used, and what they show.

namespace weft::calibration {

inline constexpr NumberRange kBoardThickness_mm = {0, 100};

/// How a board was printed, as far as somebody said.
struct BoardSettings {
  std::optional<std::string> kind;  ///< "charuco" or "checkerboard"
  std::optional<int> squares_x, squares_y;
  std::optional<double> square_mm, marker_share, thickness_mm;
  std::optional<std::string> dictionary;
  std::optional<int> first_marker = {};
};
void describe(Fields& fields, BoardSettings& settings);

/// The same as board.toml says it.
struct BoardDescription : BoardSettings {};
void describe(Fields& fields, BoardDescription& board);

/// A board that lies on something.
struct PrintedBoard {
  Board board;
  double thickness_mm = 0;
};

/// The keys of `file` (board.toml; it may be absent), overridden by `said`. kBadData names a key that is
/// unknown, missing or wrong; kUsage as check_board().
Result<PrintedBoard> read_board_file(const std::filesystem::path& file, const BoardSettings& said);

/// One photograph of a board, and what was found in it.
struct BoardPhotograph {
  std::string name;       ///< of the file
  bool of_table = false;  ///< its name starts with "table"
  ShotMetadata shot;      ///< empty of a developed photograph
  Size size;
  BoardSighting sighting;
  std::vector<TagSighting> tags;  ///< of photographs of the table, without the board's own
  std::string left_out;           ///< why it is not used; empty: it is
};

/// All photographs of a folder.
struct BoardPhotographs {
  std::vector<BoardPhotograph> photographs;  ///< by name
  ShotMetadata camera;  ///< what those that are used agree in: model, serial, f_number, focal_mm
  Size size;
};

/// What is looked for in a folder of photographs.
struct BoardFolderOptions {
  std::filesystem::path folder;
  Board board;
  std::string tag_dictionary = "DICT_APRILTAG_36h11";
  BoardLimits limits = {};
  /// The camera they must be of; without one that of most photographs.
  std::optional<CalibrationSubject> subject = {};
  std::optional<Size> size = {};  ///< of its frames; without it that of most photographs
};

/// Looks at one photograph by itself. Errors: those of find_tags().
Result<BoardPhotograph> read_board_photograph(const std::filesystem::path& file,
                                              const BoardFolderOptions& options);

/// Looks at every photograph of a folder (all files but hidden ones and .toml, .json, .txt, .md), several at
/// once: memory holds one a thread, 8 bytes a photosite of a raw one and 17 a pixel of a developed one.
/// Photographs that cannot be read, are of another camera, size, aperture or focal length, or show no board
/// that can be used are left out and say why; so is one that is 1.7 times as blurred as the median. kNoInput
/// for a folder that is not there or holds none; all are left out where none is of `subject` and `size`.
Result<BoardPhotographs> read_board_photographs(const BoardFolderOptions& options, const JobContext& context);

}  // namespace weft::calibration
