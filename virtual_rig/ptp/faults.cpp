// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/faults.h"

#include <algorithm>
#include <array>

namespace weft::virtual_rig::ptp {

namespace {

using enum PtpFault;
using enum Befalls;

constexpr auto kFaultKinds = std::to_array<PtpFaultKind>({
    {kDropInExposure, kShot, "drop_in_exposure",
     "The link breaks while the shutter is open and the picture is lost; over USB the cable is back after "
     "a while."},
    {kDropBeforeObject, kShot, "drop_before_object",
     "The link breaks when the host asks what the picture is like, before any of it is sent."},
    {kDropInData, kShot, "drop_in_data", "The link breaks when half of the picture has been sent."},
    {kOldShot, kShot, "old_shot",
     "The link breaks while the shutter is open, and the picture is the first thing that the next session "
     "gets."},
    {kNoAnswer, kShot, "no_answer",
     "The camera never answers the command to take the picture, and takes none."},
    {kDataStalls, kShot, "data_stalls",
     "Half of the picture is sent and then nothing more, with the link intact."},
    {kDataEndsEarly, kShot, "data_ends_early",
     "The picture's transfer ends, as if it were whole, at half its length."},
    {kOpenSessionSilent, kConnection, "open_session_silent",
     "The camera does not answer when a session is opened, until it is reset over USB or connected again."},
    {kCardFull, kConnection, "card_full",
     "The card holds so many pictures that the camera does not get to the end of listing them."},
    {kTurnedAway, kConnection, "init_fail", "The camera turns the host away (PTP/IP InitFail)."},
    {kRefused, kBefore, "refused", "The camera's port is closed to new connections for a while."},
    {kCaptureBusy, kShot, "capture_busy",
     "The camera says that it is busy when asked for the picture, for two seconds."},
    {kBusyForEver, kShot, "busy_for_ever",
     "The camera says that it is busy from this picture on until the link is closed; the picture is lost."},
    {kNoObject, kShot, "no_object", "The camera exposes and never says that there is a picture."},
    {kObjectSizeLie, kShot, "object_size_lie", "The camera says that the picture is twice as long as it is."},
    {kShortData, kShot, "short_data",
     "The file is cut off at half its length, and the camera says so long it is."},
    {kNoCaptureComplete, kShot, "no_capture_complete",
     "The picture comes without the word that it is complete."},
    {kPropertyNoise, kShot, "property_noise", "Ten changes of properties are announced around the picture."},
    {kUnsupportedProperty, kShot, "unsupported_property",
     "A change is announced of a property that the camera does not have."},
    {kFileLate, kShot, "file_late",
     "The picture is announced long after its exposure, when nobody waits for it."},
    {kDuplicateFrame, kShot, "duplicate_frame",
     "The file of the picture before is delivered again as this one's."},
    {kPowerCycle, kShot, "power_cycle",
     "The camera is switched off in the exposure, and on again after a while."},
    {kPowerOff, kShot, "power_off", "The camera is switched off in the exposure and stays off."},
    {kPowerOffInData, kShot, "power_off_in_data",
     "The camera is switched off when half of the picture has been sent, and stays off."},
    {kPowerOffNow, kBefore, "power_off_now",
     "The camera is switched off between two exposures and stays off."},
    {kPowerOn, kBefore, "power_on", "The camera is switched on."},
    {kBatteryLow, kBefore, "battery_low", "The battery falls to 5 percent."},
    {kDialTurned, kBefore, "dial_turned", "Somebody turns the dial from M to P."},
    {kRawOff, kBefore, "raw_off", "Somebody sets the picture quality to JPEG."},
    {kExposureChanged, kBefore, "exposure_changed", "Somebody changes the shutter time by a step."},
    {kClockBack, kBefore, "clock_back", "The camera's clock is set back by an hour."},
    {kClockAhead, kBefore, "clock_ahead", "The camera's clock is set ahead by an hour."},
    {kClockReset, kBefore, "clock_reset", "The camera's clock begins anew at the year 2000."},
    {kAutoIsoOn, kBefore, "auto_iso",
     "Somebody switches auto ISO on: pictures are taken at four times the ISO that is set."},
    {kLongNoiseOn, kBefore, "long_exposure_noise",
     "Somebody switches the noise reduction of long exposures on: beyond a second the camera takes a dark "
     "picture after each, as long, and subtracts it."},
    {kUsbUnplug, kShot, "usb_unplug", "The USB cable is pulled in the exposure and stays out."},
    {kUsbUnplugInData, kShot, "usb_unplug_in_data",
     "The USB cable is pulled when half of the picture has been sent, and stays out."},
    {kUsbUnplugNow, kBefore, "usb_unplug_now",
     "The USB cable is pulled between two exposures and stays out."},
    {kUsbReplug, kBefore, "usb_replug",
     "The USB cable is pulled and put in again: the same camera, a new address."},
    {kUsbClaimed, kConnection, "usb_claimed",
     "Another program has claimed the camera, and lets go after a while."},
    {kUsbTimeout, kShot, "usb_timeout", "The transfer of the picture ends by a time-out of the bus."},
    {kUsbStaleSession, kConnection, "usb_stale_session",
     "The session of a host that was killed is still open: the camera answers Session Already Open."},
    {kLiveStalls, kLook, "live_stalls", "The camera does not answer when asked for a picture of live view."},
    {kLiveEnds, kLook, "live_ends", "The camera ends live view by itself."},
    {kNeverLive, kLook, "never_live",
     "The camera starts live view and says ever after, until it is switched off, that it is not in it."},
    {kWell, kBefore, "well",
     "All is well again: power, cable, battery, dial, quality, clock; faults that still wait are forgotten."},
});

}  // namespace

std::span<const PtpFaultKind> fault_kinds() {
  return kFaultKinds;
}

const PtpFaultKind* find_fault(std::string_view name) {
  const auto found = std::ranges::find(kFaultKinds, name, &PtpFaultKind::name);
  return found == kFaultKinds.end() ? nullptr : &*found;
}

bool FaultSchedule::take(PtpFault fault, int now) {
  return std::erase_if(waiting_, [=](const Waiting& one) { return one.fault == fault && one.at == now; }) > 0;
}

bool FaultSchedule::waits(PtpFault fault, int at) const {
  return std::ranges::any_of(waiting_,
                             [=](const Waiting& one) { return one.fault == fault && one.at == at; });
}

}  // namespace weft::virtual_rig::ptp
