// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace weft::simulator {

/// Where the repository keeps its measured spectra.
inline const std::filesystem::path kTables = std::filesystem::path(WEFT_SOURCE_DIR) / "testdata/spectra";

}  // namespace weft::simulator
