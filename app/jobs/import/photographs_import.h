// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/jobs/import/import_plan.h"
#include "app/jobs/import/source_folders.h"
#include "core/json_document.h"
#include "core/result.h"

namespace weft::app {

/// What would become of light files and folders in the layout of the DiLiGenT benchmark: NAME.photos in the
/// archive, after the folder, of several light files in one also after the file. What cannot be solved as it
/// is, is refused.
std::vector<PlannedPhotographs> plan_photographs(const SourceFolders& found,
                                                 const std::filesystem::path& archive);

/// The three text files of the layout, and photographs.json (weft.photographs/1), by name and text. Names of
/// photographs are those of stored_names().
struct PhotographTexts {
  std::string names, directions, intensities;
  Json document;
};
PhotographTexts texts_of(const PlannedPhotographs& planned);

/// The names of the photographs in the folder that is made: their own, where each has another one.
std::vector<std::string> stored_names(const PhotoPlan& photos);

}  // namespace weft::app
