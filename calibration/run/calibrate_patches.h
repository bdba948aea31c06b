// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calibration/run/calibrate_outcome.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

struct CalibratePatchesOptions {
  std::filesystem::path session = {};      ///< taken with the rig as it was calibrated
  std::filesystem::path patches = {};      ///< where white patches lie in its pictures; empty: beside the
                                           ///< session, else by the rig's cards (calibration/run/tag_cards.h)
  std::filesystem::path from = {};         ///< the calibration to add them to; empty: the session's own
  std::filesystem::path output = {};       ///< the new calibration, which must not be there yet
  std::optional<double> paper_delta = {};  ///< as CalibrateCheckOptions has it
};
void describe(Fields& fields, CalibratePatchesOptions& options);

/// Measures white patches on the table by the light that the calibration knows, and writes a calibration with
/// them in its lights.json: what later scans tell of drift and of moves by. patches.toml: for each a
/// [[patch]] of polygon_px, three corners or more, [[x, y], ...], of which only what lies well inside is
/// read; height_mm, where it lies (else as high as the tags), and delta, how it falls off (else as the paper
/// of the lights), are kept with it.
///
/// Errors: as plan_session(); kBadData for a description that cannot be used, a patch that cannot be read, or
/// one whose reflectance differs from LED to LED by more than 10 percent: it is not white, flat and in the
/// light. Then nothing is written.
Result<CalibrateOutcome> calibrate_patches(const CalibratePatchesOptions& options, const JobContext& context);

/// What is said where a new `part` ("camera", "lights") is measured, by which old patches mean nothing.
std::string patches_left_out(const std::string& part);

}  // namespace weft::calibration
