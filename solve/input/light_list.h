// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"

// Lights of photographs, as people and programs write them down (docs/formats.md, "Photographs under distant
// lights").

namespace weft::solve {

/// A light, and the photograph that was taken under it.
struct ListedLight {
  std::string name = {};                  ///< of its photograph, as written; empty: the file names none
  std::filesystem::path photograph = {};  ///< where it lies; empty until find_photographs()
  /// x to the right, y up, z to the camera: unit length, or the position in the file's units.
  Vec3 toward = {};
  /// Reading of a white surface that faces the light, R G B; above 0.
  std::array<double, 3> strength_rgb = {1, 1, 1};
  std::string view = {};  ///< Meshroom's number of its photograph; empty: there is none

  Vec3 direction() const { return normalized(toward); }
};

struct LightList {
  std::filesystem::path file = {};  ///< that holds the lights
  std::string kind = {};            ///< "RTI light file"
  bool are_positions = false;       ///< seen from the middle of the picture; else directions
  bool have_strengths = false;
  std::vector<ListedLight> lights = {};
  /// What was taken for granted, each a few words: "decimal commas". Empty: it is as written.
  std::vector<std::string> assumed = {};
};

/// The lights of a file: a table of text, .npy, or JSON of RelightLab or Meshroom; beside light_directions.*
/// also what filenames.txt and light_intensities.* say, beside Meshroom's the .sfm that names its views. Each
/// kind is known by its bytes. kNoInput; kBadData for what is none of these, with the line, and for lists of
/// unequal length.
Result<LightList> read_light_list(const std::filesystem::path& file);

/// The same of bytes, without what lies beside: `file` is for messages and relative names.
Result<LightList> parse_light_list(std::string_view bytes, const std::filesystem::path& file);

/// The light file of a folder of photographs: in it, else in the folder above or in "assembly-files" beside
/// it. kNoInput where there is none; kBadData where there are several.
Result<std::filesystem::path> find_light_file(const std::filesystem::path& folder);

/// Those files of a folder that by their names hold lights, as people count. A JSON file is looked into.
std::vector<std::filesystem::path> light_files_in(const std::filesystem::path& folder);

/// Where the photographs of a list are.
struct PhotographPlace {
  std::filesystem::path folder = {};  ///< empty: as the list says, else near its file
  bool skips_missing = false;         ///< leaves out lights whose photograph is not there
};

/// Finds the photograph of each light, by its name or, where the list has none, by the folder's order as
/// people count. What names say otherwise than the files (folder, case, ending) goes to `assumed`. kNoInput
/// for a photograph that is not there, with where it was looked for; kBadData where several files may be
/// meant and where counts differ.
Result<void> find_photographs(const PhotographPlace& place, LightList& list);

/// Both: the lights of `file` or, where it is empty or a folder, of the light file found there.
Result<LightList> find_lights(const std::filesystem::path& file, const PhotographPlace& place);

/// "12 lights, RTI light file; decimal commas; ..." with what was assumed, for one line.
std::string words_of(const LightList& list);

}  // namespace weft::solve
