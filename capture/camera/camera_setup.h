// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/camera/camera_profile.h"
#include "capture/camera/gphoto_camera.h"
#include "capture/camera/photograph_evidence.h"
#include "capture/devices.h"
#include "core/base/result.h"

namespace weft::capture {

/// Which camera a rig means.
struct WantedCamera {
  std::string port;    ///< empty or "usb:...": the one of that serial number wherever it is plugged in
  std::string serial;  ///< empty: any
};

/// Finds the camera and opens it. Errors: kNoDevice, kTryAgain, and kBadData for another model or number and
/// where several may be meant.
Result<std::unique_ptr<GphotoCamera>> open_camera(const CameraProfile& profile, const WantedCamera& wanted);

/// Its number without the zeros that a body puts before it.
Result<std::string> serial_of(GphotoCamera& camera, const CameraProfile& profile);

/// Refuses what a person must mend: dial, lens, battery (kBadData with what to do). Under 2 ms.
Result<void> check_body(GphotoCamera& camera, const CameraProfile& profile);

/// Sets all that is not exposure, and reads it back.
Result<void> lock_settings(GphotoCamera& camera, const CameraProfile& profile);

/// Share of the battery that is left; 1 on mains.
Result<double> battery_of(GphotoCamera& camera, const CameraProfile& profile);

/// Throws away the photographs that the camera still has to deliver: until it has been quiet twice, 2 s at
/// most. Returns how many there were.
Result<int> drop_old_photographs(GphotoCamera& camera);

Result<ExposureSettings> exposure_of(GphotoCamera& camera, const CameraProfile& profile);
/// Each to the nearest listed value within 1 percent, read back.
Result<ExposureSettings> set_exposure(GphotoCamera& camera, const CameraProfile& profile,
                                      const ExposureSettings& wanted);
Result<std::vector<double>> shutter_times_us(GphotoCamera& camera, const CameraProfile& profile);

/// `watched`: up to 1.5 s, until the clock's second changes, for a few hundredths. Else a glance, which is
/// sure to half a second and half of what the answer took. Nothing where there is no clock or it stands.
std::optional<CameraClock> read_clock(GphotoCamera& camera, const CameraProfile& profile, bool watched);

}  // namespace weft::capture
