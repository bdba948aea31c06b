// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <span>

#include "virtual_rig/ptp/virtual_camera.h"

namespace weft::virtual_rig::ptp {

/// Where the bodies differ.
struct BodyFacts {
  const char* model;  ///< as DeviceInfo has it
  std::uint16_t usb_product;
  std::chrono::milliseconds shutter_lag;  ///< from the command until the shutter opens
  std::span<const std::uint16_t> operations;
};

const BodyFacts& facts_of(CameraBody body);

}  // namespace weft::virtual_rig::ptp
