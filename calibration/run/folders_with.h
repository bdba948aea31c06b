// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/rig/session.h"

namespace weft::calibration {

/// Folders at and below `root` that hold a file of this name, in order of their paths; those inside sessions
/// are copies and left out. kNoInput where `root` cannot be read.
Result<std::vector<std::filesystem::path>> folders_with(const std::filesystem::path& root, const char* name);

/// Sessions at and below `root` that hold photographs, by the time of the first; what cannot be read is left
/// out. kNoInput as above.
Result<std::vector<Session>> sessions_below(const std::filesystem::path& root);

}  // namespace weft::calibration
