// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"

namespace weft {

enum class PictureFormat {
  kJpeg,      ///< quality 92, colours at every pixel
  kPng,       ///< every value, compressed quickly
  kLiveJpeg,  ///< quality 85, colours at every fourth pixel
};

/// The bytes of an 8-bit picture of one channel or three, interleaved without gaps. The same pixels give the
/// same bytes. Error: kInternal where the library refuses it.
Result<std::string> encode_image(std::span<const std::uint8_t> samples, Size size, int channels,
                                 PictureFormat format);

}  // namespace weft
