// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "app/server/library/library_service.h"
#include "capture/rig.h"
#include "capture/scan/scan.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/session.h"
#include "library/catalogue/catalogue.h"

namespace weft::app {

/// The session that a scan makes or goes on with.
struct SessionChoice {
  std::string name;
  capture::ScanRequest request;  ///< with its folder
  bool resumed = false;          ///< it is there, unfinished
  int frames = 0;                ///< that it has
  int frames_planned = 0;        ///< where it is resumed
  std::string unfinished = {};   ///< another one of the same cloth, which its name would finish; empty: none
};

/// {"session", "resumed"}, "frames" and "frames_planned" where it is resumed, "unfinished" where there is
/// one.
Json to_json(const SessionChoice& choice);

/// Whether this rig could finish a session of that rig in that state.
bool is_resumable(const capture::Rig& rig, const std::string& of, const std::string& state);
/// The sessions in its folder that this rig could finish.
library::Query unfinished_of(const capture::Rig& rig);

/// What the body of POST /api/v1/scan asks for: the session it names, new or unfinished. Where it names none:
/// the newest unfinished one of this rig, fabric and calibration, begun as the body says as far as it says
/// it, that was written at most an hour before `now`; else a new one by the rig's template. Errors: those of
/// read_scan_body(), kUsage (no fabric), kCannotCreate (the session is finished, or another rig's), kNoInput
/// and kBadData (its session.json). Nothing is made.
Result<SessionChoice> choose_session(const Json& body, const capture::Rig& rig, LibraryService& library,
                                     std::chrono::system_clock::time_point now);

/// Exposures beside its own at which a lit shot of a session may be taken once more: those whose ratio to it
/// was measured by its calibration, rising.
std::vector<double> other_exposures_us(const Session& session);

/// The scan that takes a shot of a finished session once more (capture::ScanRequest::again), with an exposure
/// of its own above 0. kCannotCreate where the session is not this rig's.
Result<capture::ScanRequest> request_again(const Session& session, const capture::Rig& rig, const Shot& shot,
                                           double exposure_us);

}  // namespace weft::app
