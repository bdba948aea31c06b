// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Numbers of PTP (ISO 15740) and of Nikon's extension to it, as far as a D5100 serves them here.
namespace weft::virtual_rig::ptp {

/// What a host asks for.
enum Operation : std::uint16_t {
  kGetDeviceInfo = 0x1001,
  kOpenSession = 0x1002,
  kCloseSession = 0x1003,
  kGetStorageIds = 0x1004,
  kGetStorageInfo = 0x1005,
  kGetNumObjects = 0x1006,
  kGetObjectHandles = 0x1007,
  kGetObjectInfo = 0x1008,
  kGetObject = 0x1009,
  kGetThumb = 0x100a,
  kDeleteObject = 0x100b,
  kInitiateCapture = 0x100e,
  kGetDevicePropDesc = 0x1014,
  kGetDevicePropValue = 0x1015,
  kSetDevicePropValue = 0x1016,
  kGetPartialObject = 0x101b,
  kCaptureRecInSdram = 0x90c0,
  kAfDrive = 0x90c1,
  kChangeCameraMode = 0x90c2,
  kDeleteSdramImage = 0x90c3,
  kGetEvent = 0x90c7,
  kDeviceReady = 0x90c8,
  kGetVendorPropCodes = 0x90ca,
  kAfCaptureSdram = 0x90cb,
  kStartLiveView = 0x9201,
  kEndLiveView = 0x9202,
  kGetLiveViewImage = 0x9203,
  kInitiateCaptureRecInMedia = 0x9207,
};

/// How it ended.
enum ResponseCode : std::uint16_t {
  kOk = 0x2001,
  kGeneralError = 0x2002,
  kSessionNotOpen = 0x2003,
  kOperationNotSupported = 0x2005,
  kInvalidStorage = 0x2008,
  kInvalidObject = 0x2009,
  kPropertyNotSupported = 0x200a,
  kAccessDenied = 0x200f,
  kNoThumbnail = 0x2010,
  kDeviceBusy = 0x2019,
  kInvalidPropFormat = 0x201b,
  kInvalidPropValue = 0x201c,
  kInvalidParameter = 0x201d,
  kSessionAlreadyOpen = 0x201e,
  kInvalidStatus = 0xa004,
  kNotLiveView = 0xa00b,
};

/// What a camera says without being asked.
enum Event : std::uint16_t {
  kObjectAdded = 0x4002,
  kDevicePropChanged = 0x4006,
  kCaptureComplete = 0x400d,
  kObjectAddedInSdram = 0xc101,
  kCaptureCompleteInSdram = 0xc102,
};

/// What can be read and set.
enum PropertyCode : std::uint16_t {
  kBatteryLevel = 0x5001,
  kImageSize = 0x5003,
  kImageQuality = 0x5004,
  kWhiteBalance = 0x5005,
  kFNumber = 0x5007,
  kFocalLength = 0x5008,
  kFocusMode = 0x500a,
  kMeteringMode = 0x500b,
  kExposureTime = 0x500d,
  kExposureProgram = 0x500e,
  kIso = 0x500f,
  kExposureBias = 0x5010,
  kDateTime = 0x5011,
  kCaptureMode = 0x5013,
  kBurstNumber = 0x5018,
  kAutoIso = 0xd054,
  kLongExposureNoise = 0xd06b,
  kHighIsoNoise = 0xd070,
  kReleaseWithoutCard = 0xd08a,
  kShutterSpeed = 0xd100,
  kExternalPower = 0xd101,
  kShotsLeft = 0xd103,
  kRecordingMedia = 0xd10b,
  kDLighting = 0xd14e,
  kFocusMode2 = 0xd161,
  kIsoAuto = 0xd16a,
  kRemoteTimeout = 0xd16b,
  kLiveViewStatus = 0xd1a2,
  kLiveViewProhibited = 0xd1a4,
};

/// What a file is.
enum ObjectFormat : std::uint16_t {
  kUndefinedFormat = 0x3000,
  kFolder = 0x3001,
  kExifJpeg = 0x3801,
  kJfif = 0x3808,
};

constexpr std::uint16_t kNikonVendor = 0x000a;
constexpr std::uint32_t kMemory = 0, kStore = 0x00010001;  // where an object is: in the body or on the card
constexpr std::uint32_t kDcimFolder = 0x10000001, kPicturesFolder = 0x10000002;
constexpr std::uint32_t kFirstCardHandle = 0x10010001, kFirstSdramHandle = 0xffff0001;

}  // namespace weft::virtual_rig::ptp
