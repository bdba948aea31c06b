// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/rig/session.h"

// What lies in a session's folder.

namespace weft::library {

/// A raw frame on disk and the digest that names it.
struct StoredFrame {
  std::filesystem::path file;
  std::string sha256;
};

/// The shot of this index. kUsage for what is no number, kNoInput.
Result<Shot> stored_shot(const Session& session, const std::string& index);
/// Its file, which lies in the session. Errors as stored_shot().
Result<StoredFrame> stored_frame(const Session& session, const std::string& index);

/// Whether a file is really there: a link in a session could lead out of it.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

/// The size of all files at and below a folder; links count nothing.
std::uint64_t bytes_below(const std::filesystem::path& folder);

}  // namespace weft::library
