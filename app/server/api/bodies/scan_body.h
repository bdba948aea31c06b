// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/guide/scan_price.h"
#include "capture/rig.h"
#include "capture/scan/scan.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/rig/session.h"

namespace weft::app {

/// The JSON object of a request; an empty body is an empty object. kUsage for anything else, for more than 32
/// levels, for text that is not UTF-8.
Result<Json> parse_body(std::string_view body);

/// What a scan may be asked for, by a command or by a call. What is empty is as the rig file says, or as the
/// session was begun that is gone on with.
struct ScanWish {
  /// What the rig has; any rig, where it is not known.
  struct Has {
    int leds = 10;
    std::vector<std::string> polariser = {"crossed", "parallel"};
    bool below = true;
  };

  std::filesystem::path session;  ///< of a call the name; empty: by the rig's template
  std::string fabric;
  std::optional<double> cloth_height_mm, tilt_deg, downhill_deg;
  Json metadata = Json::object();
  std::optional<double> exposure_us, iso, f_number;
  std::vector<int> leds;
  bool repeat = true, below = true, copy = true, any_exposure = false;
  std::optional<double> bracket;
  std::optional<int> blade;
  std::vector<std::string> polariser;
  std::string accept_moved, request_id;
  bool dry_run = false;  ///< nothing is to begin: only say which session it would be
  bool only_explains = false;
  std::string like = "cotton";  ///< of calibration::planned_cloths()
  calibration::ShotsWish aims;
  Has has;
};
void describe(Fields& fields, ScanWish& wish);

/// The name under "session"; empty where there is none. kUsage.
Result<std::string> session_in_body(const Json& body);

/// What a scan is on this rig where nothing else is asked for, and how a session goes on that was begun.
capture::ScanRequest request_of_rig(const capture::Rig& rig);
capture::ScanRequest request_of_session(const Session& session, const capture::Rig& rig);

/// The body of POST /api/v1/scan, a ScanWish, over `otherwise`, on a rig of so many LEDs that has the films
/// and the light below of `otherwise`. kUsage with the field and what is allowed there; a field that is not
/// known is refused, with the nearest that is.
Result<capture::ScanRequest> read_scan_body(const Json& body, int leds,
                                            const capture::ScanRequest& otherwise);

/// What the same body says of choosing its shots.
struct ShotAims {
  calibration::ShotsWish wish;
  calibration::NamedCloth cloth;
};
Result<ShotAims> read_shot_aims(const Json& body, int leds, const capture::ScanRequest& otherwise);

}  // namespace weft::app
