// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace weft::simulator {

/// Last word of philox's counter, by what the camera draws; photon and read noise have 0 to 2.
enum CameraStream : std::uint32_t {
  kMovementStream = 0x63616D00,
  kDefectStream,
  kPhotositeStream,
  kColumnStream,
};

}  // namespace weft::simulator
