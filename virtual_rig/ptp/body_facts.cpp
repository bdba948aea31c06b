// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/body_facts.h"

#include <array>

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

}  // namespace

const BodyFacts& facts_of(CameraBody body) {
  static constexpr BodyFacts kD5100 = {"D5100", 0x0429, std::chrono::milliseconds(10), kOperations};
  static constexpr BodyFacts kD80 = {"D80", 0x0412, std::chrono::milliseconds(80),
                                     std::span(kOperations).first(kWithoutLiveView)};
  return body == CameraBody::kD80 ? kD80 : kD5100;
}

}  // namespace weft::virtual_rig::ptp
