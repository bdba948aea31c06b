// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/rig/lights.h"
#include "core/rig/session.h"

namespace weft {
class Fields;
}  // namespace weft

namespace weft::capture {

/// What a person writes about a rig, in TOML (docs/rig.md). Paths in the file are relative to its folder.
struct Rig {
  std::filesystem::path file;  ///< it was read from, absolute; empty: there is no rig
  std::string name;            ///< in every session and calibration of it
  int leds = 10;               ///< 1 to 10; where the file does not say, as many as `lights` has; 0: no rig

  /// [[led]], from LED 1: where a tape has them. Aims are unit vectors, by default at the table's centre;
  /// fluxes are 1. None where nobody measured.
  std::optional<NearLights> lights;

  struct Board {
    std::string port = "/dev/weft-led";  ///< any name that leads to it
  } board;

  struct Camera {
    std::string profile = "nikon-d5100";  ///< built in, or a path to a profile
    std::string port;                     ///< "ptpip:127.0.0.1:15740:15740"; empty: found on USB
    std::string serial;                   ///< empty: the calibration's (camera_serial())
  } camera;

  /// [below]: a light below the cloth, on the board's output for it. None: there is none.
  struct Below {
    std::optional<double> exposure_us;  ///< none: metered for each cloth
  };
  std::optional<Below> below;

  /// [polariser]: one before the lens, crossed or parallel to those before the lights.
  struct PolariserFilm {
    /// What each scan photographs the LEDs in, one after the other; the first is what is solved. Empty: there
    /// is none. With one state it stands as it is; with two the board turns it.
    std::vector<Polariser> states;
    double settle_s = 0.5;  ///< from the command to turn until it stands
  } polariser;

  struct Scan {
    std::filesystem::path calibration;  ///< folder
    double iso = 100;
    double f_number = 8;
    std::optional<double> exposure_us;         ///< none: metered for each cloth
    double cloth_height_mm = 0;                ///< of the cloth's surface above the table
    std::filesystem::path sessions = "scans";  ///< where sessions without a path of their own go
    std::filesystem::path copy;                ///< a second copy of each finished session; empty: none
    std::string session_name = "{date}_{fabric}_{count}";
  } scan;

  struct Daemon {
    std::string host = "127.0.0.1";               ///< another one needs a token
    int port = 8470;                              ///< 0: any free one, written to `state`/address
    std::filesystem::path token;                  ///< a file that holds it; empty: none
    std::filesystem::path look_token;             ///< a file with that of who may only look; empty: nobody
    std::vector<std::string> names;               ///< more names that lead to it: "rig.local"
    std::vector<std::string> origins;             ///< of pages behind a proxy: "https://rig.local"
    std::vector<std::filesystem::path> archives;  ///< more folders of sessions, to look at
    bool preview = true;                          ///< each finished scan is solved once quickly, as a job
    bool is_screen_seen = true;                   ///< by the cloth: pages are black while it is photographed
    int page_dark_ms = 500;                       ///< that they have to become so; 0 to 5000
    /// Socket by which weft-virtual-rig, which plays this rig, is told what to do. Empty: a real rig.
    std::filesystem::path virtual_control;
    std::filesystem::path state;  ///< folder for its lock, address and log; empty: beside the rig file
  } daemon;

  /// Photographs and calibrations lie below it: the file's; without a file that of the sessions.
  std::filesystem::path folder() const { return file.empty() ? scan.sessions : file.parent_path(); }
};

void describe(Fields& fields, Rig::Board& board);
void describe(Fields& fields, Rig::Camera& camera);
void describe(Fields& fields, Rig::Below& below);
void describe(Fields& fields, Rig::PolariserFilm& film);
void describe(Fields& fields, Rig::Scan& scan);
void describe(Fields& fields, Rig::Daemon& daemon);

/// Reads and checks the file. kNoInput, kBadData with the key and what is allowed there.
Result<Rig> read_rig(const std::filesystem::path& file);

/// The calibration that the rig file names now, which may have changed since the rig was read; that of `rig`
/// where the file cannot be read.
std::filesystem::path calibration_now(const Rig& rig);

/// The serial number of the rig's camera: the rig file's, else that of the body its calibration is of. Empty:
/// neither names one, and any camera will do.
std::string camera_serial(const Rig& rig);

}  // namespace weft::capture
