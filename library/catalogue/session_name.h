// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace weft::library {

inline constexpr std::size_t kMostSessionNameBytes = 100;

/// Whether a session may be called so: one path segment of at most kMostSessionNameBytes that is plain
/// (plain_name() of core/base/text.h), not beginning with a dot or a dash. Its folder is NAME.weft.
bool is_session_name(const std::string& name);

/// The folder of the session of this name in `sessions`, there or not. kUsage if it may not be called so,
/// kBadData if it is there and no folder of its own (a link leads elsewhere).
Result<std::filesystem::path> session_folder(const std::filesystem::path& sessions, const std::string& name);

/// A name that no session in `sessions` has, by a template with {date} 2026-11-21, {time} 142501, {fabric},
/// {rig} and {count} (from 001, the first that is free; without it "_2" and so on is appended where the name
/// is taken). What a name may not hold becomes a dash. kBadData if the template cannot give a name.
Result<std::string> next_session_name(const std::string& name_template, const std::string& fabric,
                                      const std::string& rig, const std::filesystem::path& sessions,
                                      std::chrono::system_clock::time_point now);

}  // namespace weft::library
