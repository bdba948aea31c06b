// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/result.h"

namespace weft::capture {

/// Copies a finished session into `folder` (on another disk), every file verified by its digest as it reads
/// back. It is made aside and renamed: what is there under the session's name is whole. kCannotCreate where
/// another folder of that name is there.
Result<void> copy_session(const std::filesystem::path& session, const std::filesystem::path& folder);

}  // namespace weft::capture
