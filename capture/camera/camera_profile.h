// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::capture {

/// Where one body differs from the next: what libgphoto2 calls it and its settings. docs/rig.md shows one.
struct CameraProfile {
  std::string model;                    ///< as the camera names itself: "D5100"
  std::vector<std::string> usb_models;  ///< as libgphoto2 names it on USB
  std::string ptpip_model = "PTP/IP Camera";
  /// When libgphoto2's trigger returns: once the shutter has closed, or at once, before it has opened. The
  /// second is safe with either kind of body: the LED is lit for longer.
  enum class Trigger { kBlocks, kReturnsAtOnce } trigger = Trigger::kReturnsAtOnce;
  double readout_s = 5;         ///< most a photograph takes from the end of its exposure until it has arrived
  double shutter_travel_s = 0;  ///< from the exposure of the first row to that of the last; 0: nobody knows
  double least_battery = 0.15;  ///< share

  /// Names of libgphoto2's widgets (`gphoto2 --list-config`, the last part of each).
  struct Widgets {
    std::string shutter, iso;
    std::string f_number;  ///< empty: the aperture is a ring on the lens, and what is asked for is believed
    std::string model = "cameramodel";
    std::string serial = "serialnumber";
    std::string battery = "batterylevel";  ///< empty: it runs on mains
    std::string clock = "datetime";        ///< empty: no photograph's own time is used
  } widgets;

  /// What only a person can set at the body, and what to tell him.
  struct ByHand {
    std::string widget;
    std::vector<std::string> values;  ///< that are right
    std::string says, remedy;
  };
  std::vector<ByHand> by_hand;

  using Setting = std::pair<std::string, std::string>;  ///< widget, value
  std::vector<Setting> set;                             ///< each must be there and take the value
  std::vector<Setting> set_where_there;                 ///< bodies without this widget are fine as well
};

void describe(Fields& fields, CameraProfile::Widgets& widgets);
void describe(Fields& fields, CameraProfile::ByHand& by_hand);
void describe(Fields& fields, CameraProfile& profile);

/// The profile of this name that is built in ("nikon-d5100"), or the one of a TOML file (a name that ends in
/// ".toml"). Errors: kUsage (no such name), kNoInput, kBadData with the key.
Result<CameraProfile> read_camera_profile(const std::string& name_or_file);

/// The built-in profile as a file that may be written out and changed.
std::string_view nikon_d5100_toml();

}  // namespace weft::capture
