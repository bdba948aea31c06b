// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "virtual_rig/board/lit_log.h"

namespace weft::virtual_rig {

/// One exposure that the camera has just ended.
struct CameraExposure {
  RigClock::time_point opened, closed;  ///< of the shutter
  double exposure_us = 0;
  double readout_s = 0;  ///< from the first row's exposure to that of the last
  double iso = 0;
  double f_number = 0;
  std::uint32_t image_number = 0;  ///< the body's count of shots
  std::string date_time;           ///< by its clock, "2026:01:31 23:59:58"
  int milliseconds = 0;            ///< of date_time
  bool loses_its_dark = false;     ///< noise reduction: the body subtracts a dark picture as long
};

/// Makes the file of an exposure: its bytes. Called on a thread of the camera's; what it takes is read-out.
using DevelopExposure = std::function<Result<std::vector<std::uint8_t>>(const CameraExposure&)>;

/// What its finder shows at this moment: the bytes of a JPEG.
using LookThrough = std::function<std::vector<std::uint8_t>()>;

/// The bodies that the camera can be.
enum class CameraBody {
  kD5100,  ///< is busy while its shutter is open, which libgphoto2's trigger waits for
  /// Takes pictures to its card by the command that PTP itself has (InitiateCapture), which it answers at
  /// once: libgphoto2's trigger returns before the shutter opens, 80 ms later.
  kD80,
};

/// The camera as it is when it is switched on, and how a host reaches it.
struct VirtualCameraOptions {
  CameraBody body = CameraBody::kD5100;
  std::string serial = "6000001";
  Size size = {};         ///< what it says its pictures are
  double battery = 0.87;  ///< share left
  bool dial_manual = true;
  bool raw = true;                 ///< set to raw when it is switched on
  double clock_offset_s = 0;       ///< of its clock to this machine's
  std::uint32_t shots_before = 0;  ///< its image numbers follow these
  std::uint16_t port = 0;          ///< PTP/IP on 127.0.0.1; 0: a free one
  std::filesystem::path usb = {};  ///< a socket for the libusb stand-in; empty: no USB
  double readout_s = 1.0 / 60;     ///< from its first row's exposure to that of the last
  double away_s = 2;               ///< how long what is pulled out or switched off by a fault is away
  double late_s = 8;               ///< how late a picture is that comes late
  LookThrough finder = {};         ///< for live view, 15 pictures a second; none: it is black
  double finder_s = 600;           ///< after so long live view ends by itself
};

/// What may befall a camera, from the next step of its kind on. `shot` counts from 1 from now on.
struct CameraFault {
  std::string name;  ///< "drop_in_exposure", ...: every row of the fault table; camera_faults() lists them
  int shot = 1;      ///< befalls this one; for faults of a connection: this connection
};
/// Names and a sentence each.
const std::vector<std::pair<std::string, std::string>>& camera_faults();

/// A Nikon as libgphoto2 meets one: PTP (ISO 15740) over PTP/IP (CIPA DC-005) and, by the stand-in for
/// libusb, over USB; one body, so that what one link does the other sees.
class VirtualCamera {
 public:
  static Result<std::unique_ptr<VirtualCamera>> start(const VirtualCameraOptions& options,
                                                      DevelopExposure develop);
  virtual ~VirtualCamera() = default;
  virtual std::uint16_t port() const = 0;
  /// Exposures since it was made.
  virtual int shots() const = 0;
  /// kUsage for an unknown name and for a shot below 1.
  virtual Result<void> inject(const CameraFault& fault) = 0;
};

}  // namespace weft::virtual_rig
