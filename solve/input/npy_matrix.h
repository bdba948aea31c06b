// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace weft::solve {

/// Whether these are the first bytes of a NumPy array.
bool is_npy(std::string_view bytes);

/// The rows of a NumPy array (format 1 to 3: "\x93NUMPY", a heading, then the numbers) of two dimensions in C
/// order, of little-endian float32 or float64. kBadData for any other, with what it is.
Result<std::vector<std::vector<double>>> read_npy_matrix(std::string_view bytes,
                                                         const std::filesystem::path& file);

}  // namespace weft::solve
