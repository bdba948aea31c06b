// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

// Each table says where it is made what its columns are.

namespace weft::bench {

Result<Rows> capture_board_table(const StudyOptions& options);
Result<Rows> capture_evidence_table(const StudyOptions& options);
Result<Rows> capture_focus_table(const StudyOptions& options);
Result<Rows> capture_live_view_table(const StudyOptions& options);
Result<Rows> capture_minutes_table(const StudyOptions& options);
Result<Rows> capture_camera_table(const StudyOptions& options);
Result<Rows> capture_scans_table(const StudyOptions& options);

/// Example scenes, cloths that evidence by light was made for and cloths that it was not.
std::vector<std::string> evidence_scenes();

}  // namespace weft::bench
