// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/ball/ball_lights.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image_io/linear_image.h"
#include "solve/input/light_list.h"

// The lights of photographs from a ball among what was photographed, or photographed before it.

namespace weft::calibration {

struct BallsOptions {
  std::filesystem::path photographs;  ///< their folder
  std::filesystem::path ball_folder;  ///< of the ball alone, under the same lamps; empty: it is in them
  std::filesystem::path output;       ///< .lp to write; empty: lights.lp in `photographs`
  std::filesystem::path mask_folder;  ///< where mask.png goes; empty: to `photographs`
  Transfer transfer = Transfer::kAuto;
  BallOptions ball;  ///< pixels of the photographs as they are shown
};

struct BallsReport {
  BallLights lights;  ///< pixels of the photographs as they are shown
  /// `file` is what was written: directions, or positions in mm over the middle of what the balls lie on.
  solve::LightList list;
  std::filesystem::path picture;
  std::filesystem::path mask;  ///< empty: none was needed, or one was there
  /// What one pixel is on what the balls lie on, where lamps have positions.
  std::optional<double> mm_per_pixel;
  std::vector<std::string> notes;
};

/// Reads all photographs of the folder, masks and balls.png left out; raws, if there are any, else the
/// others. Writes the light file; balls.png beside it, with circles and highlights; and where the ball is in
/// them mask.png, which keeps it out of a solve. Balls photographed before go by name, else by order as
/// people count. Photographs of more than 2000 pixels are looked at in squares' means. Errors of
/// lights_of_balls() and of reading; kNoInput without photographs; kBadData where they differ in size or
/// number; kCannotCreate for a file that is there.
Result<BallsReport> lights_by_balls(const BallsOptions& options);

Json json_of(const BallsReport& report);

/// The greatest value of all shots with each ball's circle, and each ball near with its highlights by number.
/// `by`: pixels of the photographs a pixel of `shots`.
Result<void> write_ball_picture(const std::filesystem::path& file, const std::vector<Image<float>>& shots,
                                const BallLights& lights, int by);

}  // namespace weft::calibration
