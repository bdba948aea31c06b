// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/body.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "virtual_rig/ptp/codes.h"

namespace weft::virtual_rig::ptp {
namespace {

// What both serve, and last what a body with live view does: libgphoto2 takes that for a body's kind.
constexpr std::array<std::uint16_t, 28> kOperations = {kGetDeviceInfo,      kOpenSession,
                                                       kCloseSession,       kGetStorageIds,
                                                       kGetStorageInfo,     kGetNumObjects,
                                                       kGetObjectHandles,   kGetObjectInfo,
                                                       kGetObject,          kGetThumb,
                                                       kDeleteObject,       kInitiateCapture,
                                                       kGetDevicePropDesc,  kGetDevicePropValue,
                                                       kSetDevicePropValue, kGetPartialObject,
                                                       kCaptureRecInSdram,  kAfDrive,
                                                       kChangeCameraMode,   kDeleteSdramImage,
                                                       kGetEvent,           kDeviceReady,
                                                       kGetVendorPropCodes, kAfCaptureSdram,
                                                       kStartLiveView,      kEndLiveView,
                                                       kGetLiveViewImage,   kInitiateCaptureRecInMedia};
constexpr std::size_t kWithoutLiveView = kOperations.size() - 4;

constexpr std::uint32_t kAnyStore = 0xffffffff, kAtRoot = 0xffffffff;

Answer with_data(Bytes bytes) {
  return {.data = Payload::of(std::move(bytes))};
}

Answer with_array(const std::vector<std::uint32_t>& values) {
  return with_data(ByteWriter().put_array(values).take());
}

constexpr double kHalfSent_s = 0.02;  // half of a picture is on its way by then

Delivery delivery_of(PtpFault in_transfer) {
  switch (in_transfer) {
    case PtpFault::kDropInData:
      return Delivery::kHalfThenHangUp;
    case PtpFault::kDataStalls:
    case PtpFault::kPowerOffInData:
    case PtpFault::kUsbUnplugInData:
      return Delivery::kHalfThenNothing;
    case PtpFault::kDataEndsEarly:
      return Delivery::kHalfAsWhole;
    case PtpFault::kUsbTimeout:
      return Delivery::kTimeOut;
    default:
      return Delivery::kWhole;
  }
}

}  // namespace

void Timeline::at(RigClock::time_point when, std::function<void()> action) {
  {
    const std::lock_guard lock(mutex_);
    actions_.emplace(when, std::move(action));
  }
  changed_.notify_one();
}

void Timeline::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Timeline::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (actions_.empty()) {
      changed_.wait(lock, stop, [this] { return !actions_.empty(); });
      continue;
    }
    const RigClock::time_point due = actions_.begin()->first;
    if (RigClock::now() < due) {
      changed_.wait_until(lock, stop, due, [&] { return actions_.begin()->first < due; });
      continue;
    }
    const std::function<void()> action = std::move(actions_.extract(actions_.begin()).mapped());
    lock.unlock();
    action();
    lock.lock();
  }
}

const BodyFacts& facts_of(CameraBody body) {
  static constexpr BodyFacts kD5100 = {"D5100", 0x0429, std::chrono::milliseconds(10), kOperations};
  static constexpr BodyFacts kD80 = {"D80", 0x0412, std::chrono::milliseconds(80),
                                     std::span(kOperations).first(kWithoutLiveView)};
  return body == CameraBody::kD80 ? kD80 : kD5100;
}

PtpBody::PtpBody(const VirtualCameraOptions& options, DevelopExposure develop)
    : options_(options),
      facts_(facts_of(options.body)),
      develop_(std::move(develop)),
      properties_(options.battery, options.dial_manual, options.raw, options.clock_offset_s),
      image_number_(options.shots_before) {
  const auto folder = [this](std::uint32_t handle, std::uint32_t parent, const char* name) {
    objects_[handle] = {.facts = {.storage = kStore, .format = kFolder, .parent = parent, .name = name}};
  };
  folder(kDcimFolder, 0, "DCIM");
  folder(kPicturesFolder, kDcimFolder, "100D5100");
}

void PtpBody::attach(Link* network, Link* usb) {
  const std::lock_guard lock(mutex_);
  network_ = network;
  usb_ = usb;
  update_presence();
}

Answer PtpBody::transact(const Request& request, BytesView data) {
  const std::lock_guard lock(mutex_);
  if (!powered_) return {.delivery = Delivery::kHangUp};
  return serve(request, data);
}

bool PtpBody::admit_to_network() {
  const std::lock_guard lock(mutex_);
  ++connections_;
  session_silent_ = faults_.take(PtpFault::kOpenSessionSilent, connections_);
  card_full_ = faults_.take(PtpFault::kCardFull, connections_);
  return powered_ && !faults_.take(PtpFault::kTurnedAway, connections_);
}

bool PtpBody::admit_to_usb() {
  const std::lock_guard lock(mutex_);
  if (RigClock::now() < claimed_until_) return false;
  ++connections_;
  stuck_ = false;
  session_silent_ = faults_.take(PtpFault::kOpenSessionSilent, connections_);
  card_full_ = faults_.take(PtpFault::kCardFull, connections_);
  if (faults_.take(PtpFault::kUsbStaleSession, connections_)) session_open_ = true;
  if (!faults_.take(PtpFault::kUsbClaimed, connections_)) return true;
  claimed_until_ = RigClock::now() + std::chrono::duration_cast<RigClock::duration>(
                                         std::chrono::duration<double>(options_.away_s));
  return false;
}

void PtpBody::end_session() {
  const std::lock_guard lock(mutex_);
  session_open_ = stuck_ = false;
}

void PtpBody::reset() {
  const std::lock_guard lock(mutex_);
  session_open_ = session_silent_ = stuck_ = false;
}

void PtpBody::pull_cable() {
  const std::lock_guard lock(mutex_);
  break_link();
}

int PtpBody::shots() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(image_number_ - options_.shots_before);
}

Answer PtpBody::serve(const Request& request, BytesView data) {
  const auto [first, second, third, fourth, fifth] = request.parameters;
  const std::uint16_t operation = request.operation;
  const auto& operations = facts_.operations;
  if (std::ranges::find(operations, operation) == operations.end()) return {.code = kOperationNotSupported};
  if (operation == kOpenSession) return open_session();
  if (operation == kGetDeviceInfo)
    return with_data(device_info(
        {facts_.model,
         options_.serial,
         {operations.begin(), operations.end()},
         {kObjectAdded, kDevicePropChanged, kCaptureComplete, kObjectAddedInSdram, kCaptureCompleteInSdram},
         properties_.codes(false)}));
  if (!session_open_) return {.code = kSessionNotOpen};
  switch (operation) {
    case kCloseSession:
      session_open_ = stuck_ = false;
      return {};
    case kGetStorageIds:
      return with_array({kStore});
    case kGetStorageInfo:
      return first == kStore ? with_data(storage_info()) : Answer{.code = kInvalidStorage};
    case kGetNumObjects:
    case kGetObjectHandles:
      return object_handles(request);
    case kGetObjectInfo:
      return object_info(first);
    case kGetObject:
      return object(first, 0, ~std::uint64_t{0});
    case kGetPartialObject:
      return object(first, second, third);
    case kGetThumb:
      return {.code = kNoThumbnail};
    case kDeleteObject:
    case kDeleteSdramImage:
      return delete_object(first);
    case kGetDevicePropDesc:
    case kGetDevicePropValue:
    case kSetDevicePropValue:
      return property(request, data);
    case kGetVendorPropCodes:
      return with_data(ByteWriter().put_array(properties_.codes(true)).take());
    case kGetEvent:
      return events();
    case kDeviceReady:
      return ready();
    case kStartLiveView:
      return start_live_view();
    case kEndLiveView:
      return end_live_view();
    case kGetLiveViewImage:
      return live_picture();
    case kInitiateCapture:
      return capture(false);
    case kInitiateCaptureRecInMedia:
      return capture(second == 1);
    case kCaptureRecInSdram:
    case kAfCaptureSdram:
      return capture(true);
    default:  // autofocus, camera mode: nothing to see of them
      return {};
  }
}

Answer PtpBody::open_session() {
  if (session_silent_) return {.delivery = Delivery::kNothing};
  if (session_open_) return {.code = kSessionAlreadyOpen};
  session_open_ = true;
  return {};
}

Answer PtpBody::object_handles(const Request& request) const {
  if (card_full_) return {.delivery = Delivery::kNothing};
  const auto [store, format, parent, unused, unused_too] = request.parameters;
  if (store != kStore && store != kAnyStore) return {.code = kInvalidStorage};
  std::vector<std::uint32_t> handles;
  for (const auto& [handle, picture] : objects_) {
    const bool inside = parent == 0 || picture.facts.parent == (parent == kAtRoot ? 0 : parent);
    if (picture.facts.storage == kStore && inside) handles.push_back(handle);
  }
  if (request.operation == kGetObjectHandles) return with_array(handles);
  return {.parameters = {static_cast<std::uint32_t>(handles.size())}};
}

Answer PtpBody::object_info(std::uint32_t handle) {
  const auto found = objects_.find(handle);
  if (found == objects_.end()) return {.code = kInvalidObject};
  Picture& picture = found->second;
  if (picture.in_transfer == PtpFault::kDropBeforeObject) {
    picture.in_transfer.reset();
    break_link();
    return {.delivery = Delivery::kHangUp};
  }
  return with_data(ptp::object_info(picture.facts));
}

Answer PtpBody::object(std::uint32_t handle, std::uint64_t offset, std::uint64_t most) {
  const auto found = objects_.find(handle);
  if (found == objects_.end() || !found->second.bytes) return {.code = kInvalidObject};
  Picture& picture = found->second;
  const BytesView all = *picture.bytes;
  if (offset > all.size()) return {.code = kInvalidParameter};
  const BytesView part = all.subspan(offset, std::min<std::uint64_t>(most, all.size() - offset));
  Answer answer = {.parameters = {static_cast<std::uint32_t>(part.size())},
                   .data = Payload{picture.bytes, part}};
  if (const auto fault = std::exchange(picture.in_transfer, std::nullopt)) {
    answer.delivery = delivery_of(*fault);
    if (fault == PtpFault::kPowerOffInData) after(kHalfSent_s, [this] { set_power(false); });
    if (fault == PtpFault::kUsbUnplugInData) after(kHalfSent_s, [this] { unplug(); });
  }
  const bool in_memory = picture.facts.storage == kMemory;
  if (in_memory) objects_.erase(found);  // what has been fetched makes room
  return answer;
}

Answer PtpBody::delete_object(std::uint32_t handle) {
  const auto found = objects_.find(handle);
  if (found == objects_.end()) return {.code = kInvalidObject};
  if (found->second.facts.format == kFolder) return {.code = kAccessDenied};
  objects_.erase(found);
  return {};
}

Answer PtpBody::property(const Request& request, BytesView data) {
  const auto code = static_cast<std::uint16_t>(request.parameters[0]);
  if (request.operation == kSetDevicePropValue) {
    const ResponseCode response = properties_.set(code, data);
    if (response == kOk && code == kShutterSpeed) tell_changes({kExposureTime});
    if (response == kOk && code == kExposureTime) tell_changes({kShutterSpeed});
    return {.code = response};
  }
  if (code == kLiveViewProhibited) tell_prohibitions();
  std::optional<Bytes> bytes =
      request.operation == kGetDevicePropDesc ? properties_.description(code) : properties_.value(code);
  return bytes ? with_data(*std::move(bytes)) : Answer{.code = kPropertyNotSupported};
}

Answer PtpBody::events() {
  ByteWriter writer;
  writer.put(static_cast<std::uint16_t>(notices_.size()));
  for (const Notice& notice : notices_)
    writer.put(static_cast<std::uint16_t>(notice.event)).put(notice.parameter);
  notices_.clear();
  return with_data(writer.take());
}

Answer PtpBody::ready() {
  if (std::exchange(undeveloped_, false)) return {.code = kGeneralError};
  return {.code = busy() ? kDeviceBusy : kOk};
}

bool PtpBody::busy() const {
  return exposing_ || stuck_ || RigClock::now() < busy_until_;
}

Answer PtpBody::capture(bool to_memory) {
  if (busy()) return {.code = kDeviceBusy};
  ++captures_;
  if (faults_.take(PtpFault::kNoAnswer, captures_)) {
    befall_before_next();
    return {.delivery = Delivery::kNothing};
  }
  if (faults_.take(PtpFault::kCaptureBusy, captures_)) {
    busy_until_ = RigClock::now() + std::chrono::seconds(2);
    befall_before_next();
    return {.code = kDeviceBusy};
  }
  end_live_view();
  const Exposure exposure = expose(to_memory);
  const auto half = exposure.camera.opened + (exposure.camera.closed - exposure.camera.opened) / 2;
  timeline_.at(half, [this, exposure] { half_exposed(exposure); });
  timeline_.at(exposure.done, [this, exposure] { finish(exposure); });
  return {};
}

}  // namespace weft::virtual_rig::ptp
