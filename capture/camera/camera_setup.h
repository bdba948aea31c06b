// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/camera/camera_profile.h"
#include "capture/camera/gphoto_camera.h"
#include "capture/camera/photograph_evidence.h"
#include "capture/devices.h"
#include "core/base/result.h"

namespace weft::capture {

/// The serial number that the USB device at an address of libgphoto2 ("usb:001,007") has told the kernel,
/// read without opening the device. Empty where it told none. Of a Nikon it is the body's; other makers have
/// another number there, or none. `devices`: the kernel's list.
std::string usb_serial_of(const std::string& port,
                          const std::filesystem::path& devices = "/sys/bus/usb/devices");

/// A shutter time as libgphoto2 lists it, in us: "1/60", "10/25", "1.3", "0.0166s", "30". Nothing for "Bulb".
std::optional<double> shutter_us_of(std::string_view text);

/// The number of a listed ISO or aperture: "100", "f/5.6". Nothing for "Auto".
std::optional<double> number_of(std::string_view text);

/// One value that a camera can be set to.
struct Choice {
  std::string text;  ///< as the camera lists it
  double value = 0;
};

/// The listed texts that are values, rising.
std::vector<Choice> choices_of(const std::vector<std::string>& listed,
                               std::optional<double> (*value_of)(std::string_view));

/// The choice nearest to `wanted`, at most 1 percent off; else kBadData naming the ones on either side.
Result<Choice> nearest_choice(const std::vector<Choice>& choices, double wanted, const std::string& name);

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
