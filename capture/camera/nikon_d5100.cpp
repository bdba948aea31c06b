// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_profile.h"

namespace weft::capture {

std::string_view nikon_d5100_toml() {
  return R"toml(# Nikon D5100. The names are those of `gphoto2 --list-all-config`.
model = "D5100"
usb = ["Nikon DSC D5100 (PTP mode)"]
trigger = "blocks"
readout_s = 5
least_battery = 0.15

[widgets]
shutter = "shutterspeed2"  # exact fractions; "shutterspeed" rounds to 0.1 ms
iso = "iso"
f_number = "f-number"

[[by_hand]]
widget = "expprogram"
values = ["M"]
says = "the mode dial is not on M"
remedy = "turn the camera's mode dial to M"

[[by_hand]]
widget = "focusmode2"
values = ["MF (fixed)", "MF (selection)"]
says = "the lens is not on manual focus"
remedy = "set the switch on the lens to M"

[set]
imagequality = "NEF (Raw)"
capturetarget = "Internal RAM"
autofocus = "Off"
whitebalance = "Daylight"

[set_where_there]
isoauto = "Off"
autoiso = "Off"
longexpnr = "Off"
highisonr = "Off"
dlighting = "Off"
capturemode = "Single Shot"
)toml";
}

}  // namespace weft::capture
