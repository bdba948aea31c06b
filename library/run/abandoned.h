// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace weft::library {

/// Folders that processes left half made in `parent` (core/base/files.h: PartialFolder) and that nobody works
/// on: their process of this machine is gone, or they are of another machine and nothing in them has changed
/// for a day.
std::vector<std::filesystem::path> abandoned_in(const std::filesystem::path& parent);

/// The same of a session: where its solves, maps and exports are made, and `solves`.
std::vector<std::filesystem::path> abandoned_of(const std::filesystem::path& session,
                                                const std::filesystem::path& solves);

/// Removes them; how many went.
int remove_folders(const std::vector<std::filesystem::path>& folders);

}  // namespace weft::library
