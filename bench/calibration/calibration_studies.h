// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

// Each table says where it is made what its columns are.

namespace weft::bench {

Result<Rows> calibration_camera_table(const StudyOptions& options);
Result<Rows> calibration_color_table(const StudyOptions& options);
Result<Rows> calibration_degenerate_table(const StudyOptions& options);
Result<Rows> calibration_end_to_end_table(const StudyOptions& options);
Result<Rows> calibration_grey_table(const StudyOptions& options);
Result<Rows> calibration_lights_table(const StudyOptions& options);
Result<Rows> calibration_moved_table(const StudyOptions& options);
Result<Rows> calibration_response_table(const StudyOptions& options);
Result<Rows> calibration_watched_table(const StudyOptions& options);

/// Writes the error of normals in rows of lights against minutes to `folder`/pictures/calibration_poses.svg.
Result<void> write_calibration_docs(const std::filesystem::path& folder, const Rows& rows);

}  // namespace weft::bench
