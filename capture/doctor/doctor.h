// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "capture/rig.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::capture {

/// What is right or wrong with one part of a rig's set-up.
struct SetupFinding {
  enum class Verdict { kFine, kWarning, kFault };
  Verdict verdict = Verdict::kFine;
  std::string part;    ///< "board", "camera", "disk"
  std::string says;    ///< one sentence
  std::string remedy;  ///< the command that mends it, or what to do; empty where all is well
  ErrorKind kind = ErrorKind::kNoDevice;  ///< of a fault
};

const char* name_of(SetupFinding::Verdict verdict);  ///< "fine", "warning", "fault"
/// {"part", "verdict", "says", "remedy"}
Json json_of(const SetupFinding& finding);

/// What a session is reckoned with before one was taken: uncompressed frames of 16 megapixels.
inline constexpr std::uint64_t kFrameBytes = 33'000'000;
inline constexpr int kSessionFrames = 12;

/// A fault that an error is.
SetupFinding fault_of(std::string part, const Error& error);

/// Where the system tells about itself; tests bring their own.
struct SystemPlaces {
  std::filesystem::path proc = "/proc";
  std::filesystem::path sys = "/sys";
  std::filesystem::path dev = "/dev";
  std::vector<std::filesystem::path> udev = {"/etc/udev/rules.d", "/run/udev/rules.d",
                                             "/usr/local/lib/udev/rules.d", "/usr/lib/udev/rules.d",
                                             "/lib/udev/rules.d"};
};

/// A process that holds a file open, or that is known to take devices away.
struct Holder {
  int pid = 0;
  std::string name;

  friend bool operator==(const Holder&, const Holder&) = default;
};

/// The processes that hold `file` open, by what this user may see of them.
std::vector<Holder> holders_of(const std::filesystem::path& file, const SystemPlaces& places);

/// What the devices say of themselves when they are opened. Empty functions: they are looked at from outside.
struct Opened {
  std::function<Result<std::string>()> board;  ///< its greeting in words
  std::function<Result<CameraFacts>()> camera;
};
/// Board and camera: permissions, who holds them (ModemManager and brltty take boards, gvfs takes cameras),
/// who is known to take them and runs, the camera's USB speed; then what each says when it is opened, unless
/// its port has a fault already, which says more. A user may not see what root's processes hold: where the
/// board does not answer and a program runs that takes boards, that is a fault too.
std::vector<SetupFinding> examine_rig(const Rig& rig, const Opened& open, const SystemPlaces& places = {});

/// Room for sessions of `frame_bytes` a frame, whether the folders can be written, the calibration, the
/// machine's clock.
std::vector<SetupFinding> examine_folders(const Rig& rig, std::uint64_t frame_bytes);

}  // namespace weft::capture
