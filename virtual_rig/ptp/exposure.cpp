// SPDX-License-Identifier: Apache-2.0
// The body's shutter and what it makes, and what may befall both.
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "virtual_rig/ptp/body.h"
#include "virtual_rig/ptp/clock.h"

namespace weft::virtual_rig::ptp {
namespace {

constexpr std::int64_t kRawQuality = 4;
constexpr double kHour_s = 3600;
constexpr const char* kFirstTime = "20000101T000000";  ///< of a clock whose battery was changed

RigClock::duration duration(double seconds) {
  return std::chrono::duration_cast<RigClock::duration>(std::chrono::duration<double>(seconds));
}

/// What stands for the JPEG of a body that is not set to raw: a file that is one by its first bytes.
Bytes jpeg() {
  return {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 0xff, 0xd9};
}

}  // namespace

PtpBody::Exposure PtpBody::expose(bool to_memory) {
  exposing_ = true;
  Exposure exposure = {.shot = captures_, .to_memory = to_memory, .power_cycle = power_cycles_};
  CameraExposure& camera = exposure.camera;
  camera.exposure_us = properties_.exposure_us();
  camera.readout_s = options_.readout_s;
  camera.iso = properties_.taken_iso();
  camera.f_number = properties_.f_number();
  camera.opened = RigClock::now() + facts_.shutter_lag;
  camera.closed = camera.opened + duration(camera.exposure_us * 1e-6);
  camera.loses_its_dark = properties_.takes_dark_after();
  camera.image_number = ++image_number_;
  const ClockReading clock =
      read_clock(std::chrono::system_clock::now() + facts_.shutter_lag, properties_.clock_offset_s());
  camera.date_time = exif_time(clock);
  camera.milliseconds = clock.milliseconds;
  exposure.date = ptp_time(clock);
  exposure.done = camera.closed;
  if (camera.loses_its_dark) exposure.done += camera.closed - camera.opened;
  return exposure;
}

void PtpBody::half_exposed(const Exposure& exposure) {
  const std::lock_guard lock(mutex_);
  if (faults_.take(PtpFault::kOldShot, exposure.shot)) break_link();
  if (faults_.waits(PtpFault::kDropInExposure, exposure.shot)) break_link();
  if (faults_.take(PtpFault::kUsbUnplug, exposure.shot)) unplug();
  if (faults_.take(PtpFault::kPowerOff, exposure.shot)) set_power(false);
  if (faults_.take(PtpFault::kPowerCycle, exposure.shot)) {
    set_power(false);
    after(options_.away_s, [this] { set_power(true); });
  }
}

void PtpBody::finish(const Exposure& exposure) {
  std::unique_lock lock(mutex_);
  if (exposure.power_cycle != power_cycles_) return;
  const bool dropped = faults_.take(PtpFault::kDropInExposure, exposure.shot);
  const bool lost = faults_.take(PtpFault::kNoObject, exposure.shot) || dropped;
  if (faults_.take(PtpFault::kBusyForEver, exposure.shot)) {
    stuck_ = true;
  } else if (!lost) {
    lock.unlock();
    Result<Bytes> file = develop(exposure);
    lock.lock();
    if (exposure.power_cycle != power_cycles_) return;
    if (file)
      keep(exposure, *std::move(file));
    else
      undeveloped_ = true;
  }
  exposing_ = false;
  befall_before_next();
}

Result<Bytes> PtpBody::develop(const Exposure& exposure) {
  bool raw = false;
  {
    const std::lock_guard lock(mutex_);
    raw = properties_.number(kImageQuality) == kRawQuality;
  }
  if (!raw) return jpeg();
  return develop_(exposure.camera);
}

/// Puts the picture where the host looks for it and says so, or whatever else befalls it.
void PtpBody::keep(const Exposure& exposure, Bytes file) {
  const auto befalls = [&](PtpFault fault) { return faults_.take(fault, exposure.shot); };
  if (befalls(PtpFault::kShortData)) file.resize(file.size() / 2);
  const bool raw = properties_.number(kImageQuality) == kRawQuality;

  Picture picture;
  picture.bytes = std::make_shared<const Bytes>(std::move(file));
  const std::shared_ptr<const Bytes> before = std::exchange(last_file_, nullptr);
  if (befalls(PtpFault::kDuplicateFrame) && before) picture.bytes = before;
  if (faults_.waits(PtpFault::kDuplicateFrame, exposure.shot + 1)) last_file_ = picture.bytes;
  for (const PtpFault fault :
       {PtpFault::kDropBeforeObject, PtpFault::kDropInData, PtpFault::kDataStalls, PtpFault::kDataEndsEarly,
        PtpFault::kUsbTimeout, PtpFault::kPowerOffInData, PtpFault::kUsbUnplugInData})
    if (befalls(fault)) picture.in_transfer = fault;

  const std::size_t said_bytes = picture.bytes->size() * (befalls(PtpFault::kObjectSizeLie) ? 2 : 1);
  picture.facts = {
      .storage = exposure.to_memory ? kMemory : kStore,
      .format = raw ? kUndefinedFormat : kExifJpeg,
      .bytes = static_cast<std::uint32_t>(said_bytes),
      .parent = exposure.to_memory ? 0 : kPicturesFolder,
      .size = options_.size,
      .name = fmt::format("DSC_{:04}.{}", exposure.camera.image_number % 10000, raw ? "NEF" : "JPG"),
      .date = exposure.date};
  const std::uint32_t handle = new_handle(exposure.to_memory);
  objects_[handle] = std::move(picture);

  std::vector<Notice> notices = {{exposure.to_memory ? kObjectAddedInSdram : kObjectAdded, handle}};
  if (!befalls(PtpFault::kNoCaptureComplete))
    notices.push_back({exposure.to_memory ? kCaptureCompleteInSdram : kCaptureComplete, 0});
  if (befalls(PtpFault::kPropertyNoise)) {
    notices.insert(notices.begin(), 5, {kDevicePropChanged, kRecordingMedia});
    notices.insert(notices.end(), 5, {kDevicePropChanged, kExternalPower});
  }
  constexpr std::uint32_t kNoSuchProperty = 0xd1ff;
  if (befalls(PtpFault::kUnsupportedProperty))
    notices.insert(notices.begin(), {kDevicePropChanged, kNoSuchProperty});

  const auto tell = [this, notices, power_cycle = power_cycles_] {
    if (power_cycle == power_cycles_) notices_.insert(notices_.end(), notices.begin(), notices.end());
  };
  befalls(PtpFault::kFileLate) ? after(options_.late_s, tell) : tell();
}

/// The first free one.
std::uint32_t PtpBody::new_handle(bool to_memory) const {
  std::uint32_t handle = to_memory ? kFirstSdramHandle : kFirstCardHandle;
  while (objects_.contains(handle)) ++handle;
  return handle;
}

void PtpBody::inject(const PtpFaultKind& kind, int shot) {
  const std::lock_guard lock(mutex_);
  const int before = kind.befalls == Befalls::kConnection ? connections_
                     : kind.befalls == Befalls::kLook     ? looks_
                                                          : captures_;
  faults_.add(kind.fault, before + shot);
  if (!exposing_) befall_before_next();
}

void PtpBody::befall_before_next() {
  for (const PtpFaultKind& kind : fault_kinds())
    if (kind.befalls == Befalls::kBefore && faults_.take(kind.fault, captures_ + 1)) befall(kind.fault);
}

void PtpBody::befall(PtpFault fault) {
  switch (fault) {
    case PtpFault::kRefused:
      port_open_ = false;
      after(options_.away_s, [this] {
        port_open_ = true;
        update_presence();
      });
      break;
    case PtpFault::kPowerOn:
      return set_power(true);
    case PtpFault::kPowerOffNow:
      return set_power(false);
    case PtpFault::kUsbUnplugNow:
      return unplug();
    case PtpFault::kBatteryLow:
      properties_.turn(kBatteryLevel, 5);
      return tell_changes({kBatteryLevel});
    case PtpFault::kDialTurned:
      properties_.turn_dial(false);
      return tell_changes({kExposureProgram, kShutterSpeed, kExposureTime, kFNumber});
    case PtpFault::kRawOff:
      properties_.turn(kImageQuality, 2);
      return tell_changes({kImageQuality});
    case PtpFault::kAutoIsoOn:
      properties_.turn(kIsoAuto, 1);
      return tell_changes({kAutoIso, kIsoAuto});
    case PtpFault::kLongNoiseOn:
      properties_.turn(kLongExposureNoise, 1);
      return tell_changes({kLongExposureNoise});
    case PtpFault::kWell:
      faults_.forget();
      never_live_ = false;
      properties_.turn(kBatteryLevel, static_cast<int>(std::lround(100 * options_.battery)));
      properties_.turn(kImageQuality, 4);
      for (const PropertyCode code : {kIsoAuto, kLongExposureNoise}) properties_.turn(code, 0);
      properties_.turn_dial(true);
      properties_.set_clock_offset(options_.clock_offset_s);
      cable_in_ = port_open_ = true;
      claimed_until_ = {};
      set_power(true);
      break;
    case PtpFault::kExposureChanged:
      properties_.change_exposure();
      return tell_changes({kShutterSpeed, kExposureTime});
    case PtpFault::kClockBack:
      return properties_.set_clock_offset(properties_.clock_offset_s() - kHour_s);
    case PtpFault::kClockAhead:
      return properties_.set_clock_offset(properties_.clock_offset_s() + kHour_s);
    case PtpFault::kClockReset:
      return properties_.set_clock_offset(offset_when_set_to(kFirstTime).value_or(0));
    case PtpFault::kUsbReplug:
      if (cable_in_) return break_link();
      cable_in_ = true;
      break;
    default:
      break;
  }
  update_presence();
}

void PtpBody::tell_changes(std::initializer_list<PropertyCode> codes) {
  for (const PropertyCode code : codes) {
    notices_.push_back({kDevicePropChanged, code});
    for (Link* const link : {network_, usb_})
      if (link) link->announce(kDevicePropChanged, code);
  }
}

/// A network's connection can be made again at once; a cable is out for a while.
void PtpBody::break_link() {
  session_open_ = stuck_ = cable_in_ = false;
  update_presence();
  if (network_) network_->hang_up();
  after(options_.away_s, [this] {
    cable_in_ = true;
    update_presence();
  });
}

void PtpBody::unplug() {
  cable_in_ = session_open_ = false;
  update_presence();
}

void PtpBody::set_power(bool on) {
  if (on == powered_) return;
  powered_ = on;
  update_presence();
  if (on) return;
  ++power_cycles_;  // what the timeline still holds of before is void
  session_open_ = stuck_ = exposing_ = undeveloped_ = never_live_ = false;
  end_live_view();
  notices_.clear();
  std::erase_if(objects_, [](const auto& object) { return object.second.facts.storage == kMemory; });
  if (network_) network_->hang_up();
}

void PtpBody::update_presence() {
  if (network_) network_->set_present(powered_ && port_open_);
  if (usb_) usb_->set_present(powered_ && cable_in_);
}

/// The action has the lock.
void PtpBody::after(double seconds, std::function<void()> action) {
  timeline_.at(RigClock::now() + duration(seconds), [this, action = std::move(action)] {
    const std::lock_guard lock(mutex_);
    action();
  });
}

}  // namespace weft::virtual_rig::ptp
