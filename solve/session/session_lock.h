// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace weft::solve {

/// A session's folder, locked as a scan locks it for as long as the descriptor lives. kTryAgain where a scan
/// or another edit holds it, kNoInput where there is no such folder.
Result<Descriptor> lock_session(const std::filesystem::path& folder);

}  // namespace weft::solve
