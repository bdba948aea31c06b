// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "capture/rig.h"
#include "capture/scan/scan.h"
#include "core/json_document.h"
#include "core/result.h"
#include "core/session.h"

namespace weft::app {

/// The JSON object of a request; an empty body is an empty object. kUsage for anything else, for more than 32
/// levels, for text that is not UTF-8.
Result<Json> parse_body(std::string_view body);

/// What a client asks for.
struct ScanWish {
  std::string session;  ///< name of a new or unfinished one; empty: by the rig's template
  capture::ScanRequest request;
  bool dry_run = false;  ///< nothing is to begin: only say which session it would be
};

/// The name under "session"; empty where there is none. kUsage.
Result<std::string> session_in_body(const Json& body);

/// What a scan is on this rig where nothing else is asked for, and how a session goes on that was begun.
capture::ScanRequest request_of_rig(const capture::Rig& rig);
capture::ScanRequest request_of_session(const Session& session, const capture::Rig& rig);

/// The body of POST /api/v1/scan over `otherwise`, every field optional: {"session", "fabric",
/// "cloth_height_mm", "tilt_deg", "downhill_deg", "metadata", "exposure_us", "iso", "f_number", "leds",
/// "repeat", "bracket", "polariser", "below", "copy", "dry_run", "accept_moved"}. kUsage with the field and
/// what is allowed there; a field that is not known is refused, with the nearest that is.
Result<ScanWish> read_scan_body(const Json& body, int leds, const capture::ScanRequest& otherwise);

}  // namespace weft::app
