// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/run/tag_cards.h"
#include "capture/rig.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

// What a rig is calibrated with, to print: the board of its lens, the white sheet of its lights, the tags
// that stay on its table, a chart for series of exposures, a stand for a mirror ball. They fit what the
// camera sees of it.

namespace weft::calibration {

enum class TargetPart { kBoard, kSheet, kTags, kChart, kBall };
inline constexpr std::array kTargetNames = {"board", "sheet", "tags", "chart", "ball"};

enum class PaperSize { kA4, kA3, kLetter };
inline constexpr std::array kPaperNames = {"a4", "a3", "letter"};

struct TargetRequest {
  TargetPart part = TargetPart::kBoard;
  PaperSize paper = PaperSize::kA4;
  /// What the camera sees of the table; absent: as the rig's calibration knows, else 200 x 133 mm.
  std::optional<double> field_width_mm = {}, field_height_mm = {};
  double ball_mm = 40;  ///< diameter of the ball
};
void describe(Fields& fields, TargetRequest& request);

struct PrintedTarget {
  std::string name;    ///< "board"
  std::string toml;    ///< what is written of it: board.toml; empty of a chart, of which nothing is known
  std::string pdf;     ///< one page at its true size, with a bar of 100 mm to hold the printer to
  std::string says;    ///< what it is, in a line
  std::string remedy;  ///< what to do with it, in a line
};

/// `known_mm`: width and height of the field by the rig's calibration, where it has one. kUsage where the
/// target does not fit the paper.
Result<PrintedTarget> print_target(const TargetRequest& request,
                                   const std::optional<std::array<double, 2>>& known_mm);

/// The same for a rig, whose own it becomes: NAME.toml and NAME.pdf in its targets/. What was written of
/// another one there is kept as NAME.before-N.toml. Errors of print_target(), kCannotCreate, kInputOutput.
Result<PrintedTarget> print_for_rig(const TargetRequest& request, const capture::Rig& rig);
std::filesystem::path pdf_of_target(const capture::Rig& rig, const std::string& name);

/// What the camera of a calibration sees of its table, along the frame's middle lines; nothing where it knows
/// no camera.
std::optional<std::array<double, 2>> field_of(const std::filesystem::path& calibration);

}  // namespace weft::calibration
