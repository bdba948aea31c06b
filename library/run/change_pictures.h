// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "library/batch/change.h"
#include "library/batch/plan.h"

namespace weft::library {

/// A change as a picture beside a report.
struct DrawnChange {
  std::string session;
  std::string file;  ///< its name
  std::string png;   ///< its bytes
};

/// The worst window of two solves side by side, as the bytes of a PNG: the old normals, the new ones, the new
/// cloth relit, and a map of the angle between them with its scale. Errors of reading maps.
Result<std::string> draw_change(const std::filesystem::path& before, const std::filesystem::path& after,
                                const PlannedSolve& planned, const MapChange& change);

}  // namespace weft::library
