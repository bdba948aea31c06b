// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/rig/scan_verdict.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"

namespace weft::library {

/// A scan is good where its solve is so close and solves so much, and nothing was warned of.
inline constexpr double kGoodTo_deg = 2, kGoodFrom = 0.95;

/// What a scan is worth: by whether it ended, by its photographs, by what they show of the rig
/// (core/rig/seen_rig.h), and by its current solve. What a preview expects of its normals counts for nothing.
ScanVerdict verdict_of(const Session& session);

/// The same with this solve in the place of the current one, which is no preview.
ScanVerdict verdict_with(const Session& session, const SolveFacts& solve);

}  // namespace weft::library
