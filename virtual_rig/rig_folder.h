// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "simulator/bare_rig.h"
#include "virtual_rig/light/light_frames.h"

namespace weft::virtual_rig {

/// What the files of a virtual rig say.
struct RigFiles {
  std::string board_port;   ///< as libserialport names it
  std::string camera_port;  ///< empty: found on USB
  std::string camera_serial;
  std::vector<std::string> environment;  ///< "NAME=value"
  bool below = false, polariser = false;
  bool is_bare = false;  ///< never calibrated: LEDs are where a tape has them
};

/// Name of the file that VirtualRig keeps of its exposures.
inline constexpr const char* kExposureLog = "exposures.jsonl";
inline constexpr const char* kBeside =
    "beside";  ///< the port of the other serial device, and its modem lines
inline constexpr const char* kBesideModem = "beside_modem";
inline constexpr const char* kFullDisk = "disk_full";  ///< there while a host's disk is full

/// The folder of one living rig: locked while it lives, emptied of what it made at the end. What others
/// put there stays, and the folder with it.
class RigFolder {
 public:
  /// kTryAgain where another rig lives there; kCannotCreate where there is something that no rig made.
  static Result<RigFolder> take(const std::filesystem::path& folder, bool keep_log);
  RigFolder(RigFolder&& other) noexcept;
  RigFolder& operator=(RigFolder&&) = delete;
  ~RigFolder();

  const std::filesystem::path& path() const { return path_; }
  /// rig.toml, calibration/, environment, home/, targets/ and, where none is built in, the camera's profile.
  Result<void> write(const LightFrames& frames, const simulator::BareRig& rig, const RigFiles& files) const;

 private:
  RigFolder(std::filesystem::path path, int lock, bool keep_log)
      : path_(std::move(path)), lock_(lock), keep_log_(keep_log) {}
  Result<void> write_things(const simulator::BareRig& rig, bool is_bare) const;
  void remove(const char* name) const;
  void remove_made() const;

  std::filesystem::path path_;
  int lock_ = -1;
  bool keep_log_;
};

}  // namespace weft::virtual_rig
