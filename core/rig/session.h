// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/cloth_pose.h"
#include "core/rig/photo_reading.h"

namespace weft {

class Fields;

/// What a photograph is for.
enum class ShotRole {
  kLit,
  kDark,
  kRepeat,   ///< of a LED's lit shot, or with LED 0 of the dark one: what changed in between
  kBracket,  ///< a LED at another exposure
  kBelow,    ///< the light below the cloth, at an exposure of its own
  kBlade     ///< of a LED's lit shot, with a straight edge above the cloth that throws its shadow on it
};
const char* name_of(ShotRole role);  ///< "lit"

/// How the film before the camera stands to that before the lights.
enum class Polariser { kNone, kParallel, kCrossed };
const char* name_of(Polariser polariser);  ///< "crossed"
std::optional<Polariser> polariser_of(std::string_view name);

/// How the films before LEDs and lens let light through, of shots that were taken through some.
struct Films {
  double leak = 0.01;  ///< of light that keeps its polarisation, through crossed ones over parallel ones
  /// Scattered light that passes them, in either state, over what the calibration's lights say: 1 where the
  /// rig was calibrated through them, a quarter or less where it was calibrated without.
  double scattered = 1;

  friend bool operator==(const Films&, const Films&) = default;
};

/// One exposure of a session.
struct Shot {
  int index = 0;  ///< order of capture, from 0
  int led = 0;    ///< LED or light that was lit, from 1; 0 is none
  ShotRole role = ShotRole::kLit;
  std::string file;        ///< relative to the session, "raw/03_led03.dng"
  std::string sha256;      ///< of the file's bytes
  double exposure_us = 0;  ///< 0: nobody knows, of photographs that no rig took
  double iso = 100;        ///< likewise
  double f_number = 0;
  std::string time;  ///< ISO 8601, or empty
  Polariser polariser = Polariser::kNone;
  std::optional<int> superseded_by;  ///< index of the shot of the same LED and role that stands for it
  Json document;                     ///< as read, so that fields of newer minor versions survive a rewrite
};
void describe(Fields& fields, Shot& shot);

/// One scan of one cloth: a folder that can be moved. Reads and writes session.json (schema weft.session/1).
struct Session {
  std::filesystem::path folder;
  std::string fabric;
  double cloth_height_mm = 0;  ///< of the cloth's surface above the table, on the z axis
  ClothPose pose;
  std::string rig;
  std::string calibration_id;
  std::string state = "complete";  ///< "capturing" until the last frame has landed
  std::vector<Shot> shots;
  Films films;
  double shutter_travel_s = 0;  ///< from the exposure of the first row to that of the last; 0: nobody knows
  /// How photographs that no rig took, and their lights, are read: they were brought along, and there is no
  /// calibration. None: a rig took them.
  std::optional<PhotoReading> photographs;
  Json document;  ///< as read, so that fields of newer minor versions survive a rewrite

  std::filesystem::path path_of(const Shot& shot) const { return folder / shot.file; }
  std::filesystem::path calibration_folder() const { return folder / "calibration"; }
  bool is_of_rig() const { return !photographs; }
  /// The dark shot, or null.
  const Shot* dark() const;
  /// The lit shots in order of their LED, with the polariser as the first of them has it.
  std::vector<const Shot*> lit() const;
  std::vector<const Shot*> lit(Polariser polariser) const;
};
void describe(Fields& fields, Session& session);

/// Reads and checks session.json: files stay inside the folder, no LED is lit twice with one polariser, all
/// lit and dark shots of a rig share exposure, ISO and aperture, what supersedes a shot is there and is of
/// its LED and role. Superseded shots count for nothing else. The frames themselves are not opened.
Result<Session> read_session(const std::filesystem::path& folder);

/// Replaces session.json (aside, synced, renamed).
Result<void> write_session(const Session& session);

}  // namespace weft
