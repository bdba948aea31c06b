// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "simulator/scene/scene.h"
#include "simulator/simulate.h"

namespace weft::simulator {

/// What is taken of a rig.
struct CapturesOptions {
  /// Names from capture_parts(); empty: all that the scene has what is needed for.
  std::vector<std::string> parts;
  std::int64_t seed = 1;      ///< of the boards' places, the tape's errors and the frames' noise
  int boards = 15;            ///< 1 to 99
  double tape_error_mm = 10;  ///< how far each LED's tape-measured position is off, in a random direction
  SimulateOptions simulate;   ///< `calibration` and `truth` are not used
};

/// "start", "camera", "response", "color", "lights", "check".
const std::vector<std::string>& capture_parts();

/// What was written.
struct CapturesReport {
  std::vector<std::string> parts;
  int photographs = 0;  ///< single ones
  int sessions = 0;
};

/// Takes with the rig of a scene (its camera, sensor, LEDs and effects) what calibrating it needs, and
/// writes a folder a part, each made aside and renamed when complete:
///
/// - start: the calibration that the operator begins with: the camera as its data sheet has it, LEDs where a
///   tape measure puts them, aimed at the table's centre. All sessions below hold this calibration.
/// - camera: boardNN.dng, a ChArUco board in many poses, table01.dng, the same flat on the table among the
///   table's tags, and board.toml.
/// - response: dark/, led01/, led02/, led01+led02/: pairs of a white sheet at four exposures, of which the
///   shorter ones gather [camera.retakes] shutter_error more than their time says; scale/: a grey scale, with
///   scale.toml; trap/: the sheet with a black trap in its middle, where the lens has a veil.
/// - color: chart.weft, a session of the 24-patch chart; for scenes with spectra.chart and the effect
///   spectral.
/// - lights: sheet01.weft to sheet05.weft, a sheet of white paper flat and tilted by 20 degrees about x and
///   about y, sheet.toml, and rig.toml with the tape-measured LEDs.
/// - check: turned.weft, the same sheet turned by 90 degrees; other.weft, another sheet; plane.weft, a sheet
///   tilted by 15 degrees; sheet.toml and check.toml with the angle. LED 1 is lit once more at their end.
///
/// The paper is that of the scene's first target of kind paper (a white patch); tags and patches of the scene
/// stay on the table in every photograph, and where it has no tag there is one in each corner of the frame.
/// The scene's cloth is taken away; its LEDs flicker and fade in every capture as they do in scans, where it
/// has the effect led_drift. Errors: as simulate_session(); kUsage for an unknown part, for a part
/// that the scene lacks something for.
Result<CapturesReport> simulate_captures(const Scene& rig, const std::filesystem::path& folder,
                                         const CapturesOptions& options);

}  // namespace weft::simulator
