// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/result.h"

namespace weft::bench {

/// How long the library of its format takes to write the image of `file`, an EXR or PNG, to `copy` in one
/// call, as it is stored. Error: kInputOutput.
Result<double> write_alone_seconds(const std::filesystem::path& file, const std::filesystem::path& copy);

}  // namespace weft::bench
