// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "core/image_io/image_io.h"
#include "core/image_io/png_library.h"

namespace weft {

struct PngToWrite {
  Size size;
  int channels = 1;  ///< 1 to 4: grey, grey and alpha, RGB, RGB and alpha
  SampleType type = SampleType::kUint8;
  ImageAttributes attributes = {};
  PixelPitch pitch_mm = {};
  ColorSpace color = ColorSpace::kData;
};

/// A PNG whose bytes go to `put`; where that throws, the image fails. Functions return why they failed, or
/// nothing.
class PngEncoder {
 public:
  using Put = std::function<void(const void* data, std::size_t bytes)>;
  PngEncoder(const PngToWrite& image, Put put);
  ~PngEncoder();
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  std::string begin();
  std::string write(const std::byte* samples, int rows);
  std::string finish();

 private:
  void put_header(const char* description);

  PngWords words_;
  PngToWrite image_;
  Put put_;
  png_structp png_ = nullptr;
  png_infop header_ = nullptr;
};

}  // namespace weft
