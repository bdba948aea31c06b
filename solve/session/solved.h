// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/rig/session.h"
#include "solve/session/current.h"

// What is rectified, finished and exported: the folder of a session, or that of a solve of photographs.

namespace weft::solve {

/// Side of a pixel of photographs of which nobody said it, mm.
inline constexpr double kAssumedMmPerPixel = 0.1;

/// Reads a session. A folder that holds the solve of photographs under distant lights is one, too: of these
/// photographs, called as the folder is, complete, without a calibration, with that one solve. Errors of
/// read_session(); kBadData for a pixel of no size; kUsage for the solve of a session, and for a folder that
/// holds solves of photographs.
Result<Session> read_solved(const std::filesystem::path& folder);

/// Whether the folder is the solve of photographs itself: they cannot be solved again by it.
bool is_lone_solve(const Session& session);

/// A pixel of photographs that no calibrated camera took.
struct PhotographedPixel {
  double mm = kAssumedMmPerPixel;  ///< its side
  bool is_known = false;           ///< a person said it; else it is assumed
};
/// How large a pixel is of photographs that no calibrated camera took; none of a session of a rig.
std::optional<PhotographedPixel> photographed_pixel(const Session& session);

/// What a person says of the pixels of photographs is kept in session.json, or in the solve.json of a lone
/// solve, and none is left for the grid, which is theirs. That of a rig's session is of its grid, and stays.
/// Errors of read_json(), write_json() and lock_session().
Result<void> keep_pixel(const std::filesystem::path& folder, std::optional<double>& mm_per_pixel);

/// How photographs that no rig took are read from now on, in their session.json. Errors of lock_session(),
/// read_session() and write_session().
Result<void> keep_reading(const std::filesystem::path& folder, const PhotoReading& reading);

/// "the size is not known: 0.1 mm a pixel is assumed; --mm-per-pixel says it"; empty where it is known.
std::string size_words(const SourceFacts& source);

/// Why maps that say this of their source have another size than those that would be made today; empty: they
/// have not.
std::string why_other_size(const Session& session, const SourceFacts& source);

/// The fields of a document, `document` being what was read of it.
void describe_size(Fields& fields, SourceFacts& source, const Json& document);

}  // namespace weft::solve
