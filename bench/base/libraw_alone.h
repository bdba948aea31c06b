// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"

namespace weft::bench {

/// LibRaw alone: least wall seconds of three runs to open and unpack every file, the files shared out among
/// the threads.
Result<double> unpack_seconds(const std::vector<std::filesystem::path>& files, int threads);

}  // namespace weft::bench
