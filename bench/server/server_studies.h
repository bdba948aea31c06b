// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

// Each table says where it is made what its columns are.

namespace weft::bench {

Result<Rows> door_table(const StudyOptions& options);
Result<Rows> server_lease_table(const StudyOptions& options);
Result<Rows> server_library_table(const StudyOptions& options);
Result<Rows> scan_beside_table(const StudyOptions& options);
Result<Rows> viewers_table(const StudyOptions& options);
Result<Rows> server_tiles_table(const StudyOptions& options);

}  // namespace weft::bench
