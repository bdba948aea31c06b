// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

// What is measured of it: each table says in its file what its columns are.

namespace weft::bench {

Result<Rows> export_blocks(const StudyOptions& options);
Result<Rows> export_presets(const StudyOptions& options);
Result<Rows> export_losses(const StudyOptions& options);

}  // namespace weft::bench
