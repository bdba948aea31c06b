// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

// Commands of the user that bring sessions and take solves away.

namespace weft::library {

/// The command with {src} and {dst} in place, quoted for a shell.
std::string filled(const std::string& command, const std::string& src, const std::string& dst);

/// Runs it by the shell, its output to standard error. Empty where it ended with 0, else why not.
std::string run_outside(const std::string& command, const std::string& src, const std::string& dst);

/// Sends the folder of a solve: first all but solve.json, which readers believe, as links in a folder beside
/// it that goes again, then that file alone.
std::string store_outside(const std::string& command, const std::filesystem::path& solve,
                          const std::string& dst);

}  // namespace weft::library
