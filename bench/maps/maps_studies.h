// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

// Each table says where it is made what its columns are.

namespace weft::bench {

Result<Rows> maps_height(const StudyOptions& options);
Result<Rows> maps_scans(const StudyOptions& options);
Result<Rows> maps_flatten(const StudyOptions& options);
Result<Rows> maps_occlusion(const StudyOptions& options);
Result<Rows> maps_mips(const StudyOptions& options);
Result<Rows> maps_figures(const StudyOptions& options);
Result<Rows> maps_detail(const StudyOptions& options);
Result<Rows> maps_gloss(const StudyOptions& options);
Result<Rows> maps_opacity(const StudyOptions& options);

}  // namespace weft::bench
