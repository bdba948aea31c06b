// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

// Each table says where it is made what its columns are.

namespace weft::bench {

Result<Rows> export_blocks(const StudyOptions& options);
Result<Rows> export_presets(const StudyOptions& options);
Result<Rows> export_losses(const StudyOptions& options);

}  // namespace weft::bench
