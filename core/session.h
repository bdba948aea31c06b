// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json_document.h"
#include "core/result.h"

namespace weft {

/// What a photograph is for.
enum class ShotRole { kLit, kDark, kRepeat, kBracket };

/// One exposure of a session.
struct Shot {
  int index = 0;  ///< order of capture, from 0
  int led = 0;    ///< LED that was lit, from 1; 0 is none
  ShotRole role = ShotRole::kLit;
  std::string file;    ///< relative to the session, "raw/03_led03.dng"
  std::string sha256;  ///< of the file's bytes
  double exposure_us = 0;
  double iso = 100;
  double f_number = 0;
  std::string time;  ///< ISO 8601, or empty
  Json document;     ///< as read, so that fields of newer minor versions survive a rewrite
};

/// One scan of one cloth: a folder that can be moved. Reads and writes session.json (schema weft.session/1).
struct Session {
  std::filesystem::path folder;
  std::string fabric;
  double cloth_height_mm = 0;  ///< of the cloth's surface above the table
  std::string rig;
  std::string calibration_id;
  std::string state = "complete";  ///< "capturing" until the last frame has landed
  std::vector<Shot> shots;
  Json document;  ///< as read, so that fields of newer minor versions survive a rewrite

  std::filesystem::path path_of(const Shot& shot) const { return folder / shot.file; }
  std::filesystem::path calibration_folder() const { return folder / "calibration"; }
  /// The dark shot, or null.
  const Shot* dark() const;
  /// The lit shots in order of their LED.
  std::vector<const Shot*> lit() const;
};

/// Reads and checks session.json: files stay inside the folder, no LED is lit twice, all lit and dark shots
/// share exposure, ISO and aperture. The frames themselves are not opened.
Result<Session> read_session(const std::filesystem::path& folder);

/// Replaces session.json (aside, synced, renamed).
Result<void> write_session(const Session& session);

}  // namespace weft
