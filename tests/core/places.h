// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

// Where a test finds what it reads and starts, by its own program's place: build/PRESET/bin. A place compiled
// into it would make it another unit in every clone.

namespace weft {

/// Where this test program and those of the product lie.
inline std::filesystem::path program_folder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

/// The path of a program: "weft".
inline std::string program_path(const std::string& name) {
  return (program_folder() / name).string();
}

/// The folder of the sources, in which the build folder lies.
inline std::filesystem::path source_folder() {
  std::filesystem::path folder = program_folder();
  while (folder.has_relative_path() && !std::filesystem::exists(folder / "CMakePresets.json"))
    folder = folder.parent_path();
  return folder;
}

/// The path of a file of the sources: "docs/rig.md".
inline std::string in_sources(const std::string& name) {
  return (source_folder() / name).string();
}

}  // namespace weft
