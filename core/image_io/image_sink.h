// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/image_io/file_sink.h"
#include "core/image_io/image_io.h"

// What image_writer.cpp knows of the formats.

namespace weft {

/// Encodes an image into a sink, which outlives it. Dropped unfinished, it is silent.
class ImageSink {
 public:
  ImageSink() = default;
  ImageSink(const ImageSink&) = delete;
  ImageSink& operator=(const ImageSink&) = delete;
  virtual ~ImageSink() = default;

  /// The next rows, interleaved in the type of the file. All calls but the last have the same number of rows,
  /// a multiple of 32. Returns why it failed, or nothing.
  virtual std::string write(const std::byte* samples, int rows) = 0;
  virtual std::string finish() = 0;
};

/// An image that its format can hold.
struct ImageToWrite {
  Size size;
  std::vector<std::string> channels;
  WriteOptions options;
};

/// Nothing, with the reason in `why`, where the library refuses the image.
std::unique_ptr<ImageSink> exr_sink(const ImageToWrite& image, FileSink& file, std::string& why);
std::unique_ptr<ImageSink> tiff_sink(const ImageToWrite& image, FileSink& file, std::string& why);
std::unique_ptr<ImageSink> png_sink(const ImageToWrite& image, FileSink& file, std::string& why);

/// Attributes as one text of ASCII, empty where there are none.
std::string text_of_attributes(const ImageAttributes& attributes);

}  // namespace weft
