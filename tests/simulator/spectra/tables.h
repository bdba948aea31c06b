// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tests/core/places.h"

namespace weft::simulator {

/// Where the repository keeps its measured spectra.
inline const std::filesystem::path kTables = source_folder() / "testdata/spectra";

}  // namespace weft::simulator
