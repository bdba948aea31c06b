// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/camera/fixed_points.h"
#include "calibration/lights/light_map.h"
#include "calibration/lights/paper_model.h"
#include "calibration/lights/sheet_blocks.h"
#include "calibration/run/sheet_files.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "solve/report/solve_report.h"

// Sessions of a sheet of white paper, as averages of blocks.

namespace weft::calibration {

/// One session: the sheet in one pose under every LED.
struct SheetCapture {
  std::string name;                     ///< of the session's folder
  SheetPose pose;                       ///< from its tags
  std::vector<SheetBlockGrid> leds;     ///< of each LED of the rig; no columns where it was not lit
  std::vector<char> is_paper;           ///< by block of a grid: shows nothing but paper
  std::vector<std::string> lit_sha256;  ///< of its lit frames, by LED
};

/// Sessions of one sheet in several poses, block by block.
struct SheetCaptures {
  int block_px = 16;
  int columns = 0, rows = 0;  ///< of blocks
  std::vector<SheetCapture> captures;
  std::vector<FixedPoint> points;  ///< what stayed where it is beside the sheet
  std::vector<Verdict> warnings;
};

/// Where the sessions are, and what they were taken with.
struct SheetCapturesOptions {
  std::filesystem::path folder;  ///< of *.weft
  Calibration calibration;       ///< camera and response; its lights say how many LEDs there are; its
                                 ///< points keep their ids
  TaggedSheet sheet;
};

/// Reads every session of a folder, in the order of their names. Blocks are of 16 pixels, or of 8 where the
/// frame is less than 1000 pixels wide. Two frames at a time are in memory; what stays is the blocks, 4.5
/// bytes a photosite for ten LEDs in five poses.
///
/// kNoInput for a folder without sessions. kBadData, naming the file: of another rig, camera, aperture or
/// size; exposures that differ between sessions without a measured ratio; a LED that did not light; paper
/// full over more than half of it; a sheet whose tags are not found. Warnings: SAME_POSE, PAPER_FULL where
/// blocks are, LED_UNLIT where a session leaves one out.
Result<SheetCaptures> read_sheet_captures(const SheetCapturesOptions& options, const JobContext& context);

/// SHA-256 of the lit frames of a session, by LED: as its journal has them, else of the files.
Result<std::vector<std::string>> lit_sha256(const Session& session);

/// What a fit takes of captures. `left_out[capture]` marks blocks that are not to be used, by block.
/// Single blocks, those of one place side by side for all LEDs of a capture:
std::vector<PaperReading> single_blocks(const SheetCaptures& captures,
                                        const std::vector<std::vector<char>>& left_out);
/// The blocks of each cell as one, where at least half of them are paper; no more cells a side than blocks:
std::vector<PaperReading> merged_blocks(const SheetCaptures& captures,
                                        const std::vector<std::vector<char>>& left_out,
                                        const CellGrid& cells);

}  // namespace weft::calibration
