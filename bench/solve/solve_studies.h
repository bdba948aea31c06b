// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

// Each table says where it is made what its columns are.

namespace weft::bench {

Result<Rows> solve_exactness(const StudyOptions& options);
Result<Rows> solve_noise(const StudyOptions& options);
Result<Rows> solve_order(const StudyOptions& options);
Result<Rows> end_to_end(const StudyOptions& options);
Result<Rows> height_speed(const StudyOptions& options);
Result<Rows> registration(const StudyOptions& options);
Result<Rows> solve_speed(const StudyOptions& options);
Result<Rows> transport(const StudyOptions& options);

}  // namespace weft::bench
