// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/study.h"

// Each table says where it is made what its columns are.

namespace weft::bench {

Result<Rows> effects_auto(const StudyOptions& options);
Result<Rows> effects_cost(const StudyOptions& options);
Result<Rows> effects_embree(const StudyOptions& options);
Result<Rows> effects_rays(const StudyOptions& options);
/// With pictures in `folder`.
Result<Rows> effects_gallery(const std::filesystem::path& folder, int threads);

}  // namespace weft::bench
