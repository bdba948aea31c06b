// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>

#include <string>
#include <vector>

#include "core/image_io/file_sink.h"
#include "core/image_io/image_sink.h"

namespace weft {

/// Channels in the order of people rather than the alphabet: layers by name, in each of them R, G, B, A or
/// X, Y, Z first.
std::vector<std::string> in_usual_order(std::vector<std::string> names);

/// All that is said of an image in an EXR, without tiles and levels.
Imf::Header exr_header(const ImageToWrite& image);

/// Threads that decode and encode, of all files together.
int exr_threads();

/// A FileSink as OpenEXR writes to it.
class ExrStream : public Imf::OStream {
 public:
  explicit ExrStream(FileSink& file) : OStream("image"), file_(&file) {}
  void write(const char c[], int n) override { file_->write(c, static_cast<std::size_t>(n)); }
  std::uint64_t tellp() override { return static_cast<std::uint64_t>(file_->tell()); }
  void seekp(std::uint64_t offset) override { file_->seek(static_cast<std::int64_t>(offset)); }

 private:
  FileSink* file_;
};

}  // namespace weft
