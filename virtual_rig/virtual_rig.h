// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "simulator/scene/scene.h"
#include "virtual_rig/commands/command_words.h"
#include "virtual_rig/light/light_frames.h"

namespace weft::virtual_rig {

/// What a virtual rig is made of.
struct VirtualRigOptions {
  simulator::Scene scene;                          ///< its camera's body becomes `body`
  simulator::Body body = simulator::Body::kD5100;  ///< or Body::kD80: what the virtual camera says it is
  std::filesystem::path folder;  ///< everything of the rig is in it; made where it is not there
  std::filesystem::path cache = default_light_cache();
  std::filesystem::path firmware;               ///< the ELF on the board
  std::vector<std::filesystem::path> preloads;  ///< shared objects that a host of this rig needs (LD_PRELOAD)
  std::string serial = "6000001";               ///< of the camera
  double bootloader_s = 0.1;                    ///< the board is deaf for after a reset
  double clock_offset_s = 0;                    ///< of the camera's clock to this machine's
  bool below = false;      ///< a light below the cloth hangs on the board's output for it
  bool polariser = false;  ///< and films before LEDs and lens, which it turns
  /// Nobody has calibrated it: its calibration is what a data sheet and a tape say.
  bool bare = false;
  std::string beside;           ///< another serial device of the host, one of foreign_kinds(); empty: none
  bool usb = false;             ///< the camera hangs on USB, by the stand-in for libusb; else PTP/IP
  double readout_s = 1.0 / 60;  ///< from the first row's exposure to that of the last
  double away_s = 2;            ///< how long what a fault takes away is away
  double late_s = 8;            ///< how late a picture is that comes late
  std::uint16_t port = 0;       ///< of PTP/IP; 0: a free one
  /// Noise follows from the LEDs that are lit and not from the camera's count of shots: the same shot taken
  /// again is the same picture.
  bool same_noise = false;
  bool keep_log = false;           ///< exposures.jsonl stays when the rig ends
  std::vector<std::string> first;  ///< commands, done before anybody meets the rig
  RenderLightOptions render;
};

/// A rig on a table that is not there: board, camera, and the light between them. In its folder:
///   rig.toml       what a host is given (capture/rig.h), its calibration beside it
///   calibration/   the exact one, but of a bare rig
///   targets/       what is written about what can lie on its table: board.toml, sheet.toml ...
///   environment    NAME=value lines that a host needs to meet the rig
///   board, modem   the board's terminal and its modem lines
///   beside         the port of the other serial device
///   camera.sock    the camera on USB
///   control        a socket for the commands below
///   exposures.jsonl  what each exposure was: number, time, LEDs; a line is there before its file is sent
/// Rigs share nothing but the cache: any number run side by side.
class VirtualRig {
 public:
  /// Renders what the cache lacks, then starts everything. Errors: kBadData (the scene; more than ten LEDs),
  /// kTryAgain (another rig lives in the folder), kCannotCreate, kInputOutput, kInterrupted. A folder that a
  /// killed rig left is taken over; sessions in it stay.
  static Result<std::unique_ptr<VirtualRig>> start(const VirtualRigOptions& options);
  virtual ~VirtualRig() = default;  ///< ends all of it and removes what it made

  virtual const LightFrames& frames() const = 0;                    ///< until the focus is changed
  virtual const std::vector<std::string>& environment() const = 0;  ///< "NAME=value"
  /// What the control socket does with a line: "camera NAME [SHOT]", "board NAME", "light ...", "disk full",
  /// "disk room", "focus PIXELS", "stops ...", "knock ...", "table ...", "status", "commands", "end". The
  /// answer is "ok", JSON, or an error.
  virtual Result<std::string> command(const std::string& line) = 0;
  /// Readable once somebody has said "end".
  virtual int end_descriptor() const = 0;
};

/// Every command.
std::vector<CommandWords> virtual_rig_commands();

}  // namespace weft::virtual_rig
