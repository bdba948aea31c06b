// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "calibration/checks/rig_movement.h"
#include "calibration/run/rig_evidence.h"
#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/rig/calibration.h"
#include "core/rig/seen_rig.h"
#include "core/rig/session.h"
#include "core/solve/solve_parts.h"

// What a scan shows of its rig beside the cloth, held against a calibration. It lies in the session, as
// rig.json (weft.rig-look/1), with what was seen: another calibration is held against the same later, and no
// photograph is read again.

namespace weft::calibration {

struct RigLook : RigLookFacts {
  MovementCost cost;      ///< of scanning on, after patches have put levels right; the larger of two
  double least_deg = 0;   ///< where camera and table cannot be told apart, the smaller; else the same
  double chi_square = 0;  ///< an observation, with all that was found
  Json changes = Json::array();
  RigSightings seen = {};
};
void describe(Fields& fields, TagSighting& tag);
void describe(Fields& fields, SeenPatch& patch);
void describe(Fields& fields, PointSighting& point);
void describe(Fields& fields, RigLook& look);

/// What was seen against a calibration; `paper_delta` as MovementOptions has it.
RigLook look_by(const Calibration& calibration, RigSightings seen, double paper_delta = 0);
/// The same, where no patch told of LEDs, with what the cloth told of them (solve/conditions/led_gains.h).
RigLook with_cloth_gains(RigLook look, const ClothGains& gains);

/// The look that lies in a session, by its own calibration; none: nobody looked, or not at these photographs.
std::optional<RigLook> kept_look(const Session& session);

/// The look that is kept, else one that is taken now, by the session's own calibration, and kept. Errors:
/// those of solve::plan_session() and of reading frames; kBadData where the calibration has no near lights.
Result<RigLook> look_at_scan(const Session& session, const JobContext& context);

/// The session in a folder whose look was written last; empty: none has one.
std::filesystem::path looked_at_last(const std::filesystem::path& sessions);

/// The same evidence against a calibration in a folder; the look itself where it is by that. Errors of
/// read_calibration(), and kBadData as above.
Result<RigLook> look_by_another(const RigLook& look, const std::filesystem::path& calibration);
/// By the one that the rig has now; the look itself where that cannot be asked, or where there is none
/// (empty).
RigLook look_by_now(RigLook look, const std::filesystem::path& calibration);

}  // namespace weft::calibration
