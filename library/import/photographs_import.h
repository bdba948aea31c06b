// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/solve/solve_parts.h"
#include "library/import/import_plan.h"
#include "library/import/source_folders.h"

namespace weft::library {

/// What would become of photographs whose lights are in files (solve/input/light_list.h): NAME.photos in the
/// archive, after the folder, of several light files in one also after the file. Each photograph is decoded
/// once. What cannot be solved as it is, is refused.
std::vector<ProposedPhotographs> plan_photographs(const SourceFolders& found,
                                                  const std::filesystem::path& archive);

/// Takes the files that these photographs use out of frames and what is left over. Pictures beside lights
/// that nothing uses are left over, unless their lights are refused.
void drop_used(const std::vector<ProposedPhotographs>& planned, SourceFolders& found);

/// What photographs.json says (weft.photographs/1).
struct ImportedPhotographs {
  std::string from;  ///< the folder or light file that they were imported of
  std::vector<DistantPhotograph> photographs = {};
  std::string transfer = {}, mask = {};  ///< mask: its SHA-256; empty: there is none
};
void describe(Fields& fields, ImportedPhotographs& facts);
Json json_of(const ImportedPhotographs& facts);

/// The three text files of the layout, and what photographs.json says. Names of photographs are those of
/// stored_names().
struct PhotographTexts {
  std::string names, directions, intensities;
  ImportedPhotographs facts;
};
PhotographTexts texts_of(const ProposedPhotographs& planned);

/// The names of the photographs in the folder that is made: their own, where each has another one.
std::vector<std::string> stored_names(const solve::SolvePlan& photos);

}  // namespace weft::library
