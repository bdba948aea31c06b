// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/checks/flatness.h"
#include "calibration/checks/rig_movement.h"
#include "calibration/run/sheet_files.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "solve/photographs/photographs.h"

namespace weft::calibration {

/// What a sheet of paper with tags reads in squares of `square_px` (even) that show nothing but paper. LED k
/// of a square's readings is LED k + 1 of the rig; one that was left out has none. Errors as sheet_pose(),
/// with `where`; kBadData where no square shows paper alone.
Result<SheetEvidence> sheet_evidence(const Calibration& calibration, const solve::Photographs& photographs,
                                     const TaggedSheet& sheet, int square_px, const std::string& where,
                                     const JobContext& context);

/// The same squares as places that tell of movement: a surface of unknown reflectance, seen through the
/// camera.
std::vector<LitPlace> places_of(const SheetEvidence& sheet, const CameraModel& camera);

/// The file of this name in a folder, else that beside the folder.
std::filesystem::path in_or_beside(const std::filesystem::path& folder, const char* name);

}  // namespace weft::calibration
