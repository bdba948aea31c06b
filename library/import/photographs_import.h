// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "library/import/import_plan.h"
#include "library/import/source_folders.h"

namespace weft::library {

/// What would become of photographs whose lights are in files (solve/input/light_list.h): NAME.weft in the
/// archive, after the folder, of several light files in one also after the file. Each photograph is decoded
/// once. What cannot be solved as it is, is refused.
std::vector<ProposedPhotographs> plan_photographs(const SourceFolders& found, const ImportOptions& options,
                                                  const std::filesystem::path& archive);

/// The same of folders whose lights balls tell; what is found of them goes below `aside`.
std::vector<ProposedPhotographs> plan_photographs_with_balls(const ImportOptions& options,
                                                             const std::filesystem::path& archive,
                                                             const std::filesystem::path& aside);

/// Takes the files that these photographs use out of frames and what is left over. Pictures
/// beside lights that nothing uses are left over, unless their lights are refused.
void drop_used(const std::vector<ProposedPhotographs>& planned, SourceFolders& found);

}  // namespace weft::library
