// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

// What lies in the folders of a foreign archive, by names alone.

namespace weft::library {

/// A file that may be a frame.
struct SourceFile {
  std::filesystem::path file;
  std::filesystem::path root;  ///< the folder that was named and that it lies below
  bool is_developed = false;   ///< TIFF, PNG or EXR; else a raw
};

struct LeftOver {
  std::filesystem::path file;
  std::string why;
};

struct SourceFolders {
  std::vector<std::filesystem::path> roots;        ///< the folders that were named
  std::vector<SourceFile> frames;                  ///< by folder, then as people count
  std::vector<std::filesystem::path> light_files;  ///< .lp, .dome, .relight and JSON with lights
  /// Photographs whose lights are a table beside them or, without names, in the folder above.
  std::vector<std::filesystem::path> photo_folders;
  /// Pictures and raws in and below folders that have lights: of these, or of nothing.
  std::vector<std::filesystem::path> beside_lights;
  std::vector<Error> unread_lights;  ///< why a file is none of lights that has the name of such a one
  std::vector<std::filesystem::path> descriptions;  ///< import.toml and .json files
  std::vector<LeftOver> left_over;                  ///< files that are none of these, sessions of weft
};

/// Looks into the folders and those below them. Hidden files and links to folders are passed over; files of
/// photographs under distant lights are no frames. kNoInput for a folder that cannot be listed.
Result<SourceFolders> look_into(const std::vector<std::filesystem::path>& folders);

}  // namespace weft::library
