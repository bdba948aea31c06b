// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"

namespace weft {

/// Rectangles of an uncompressed scanline EXR file, as weft writes its maps: a rectangle costs what it holds,
/// however large the map is. Safe from any thread.
class ExrWindow {
 public:
  /// Looks at the header and at where rows begin. Errors: kNoInput, kBadData; kUsage for a file that is sound
  /// but compressed or tiled, which read_image() reads.
  static Result<ExrWindow> open(const std::filesystem::path& file);

  Size size() const { return size_; }
  bool has(const std::string& channel) const;

  /// The pixels of `part`, which lies inside: a plane a channel, by the names given, which are there. Errors:
  /// kInputOutput, kBadData where the file is shorter than its header says.
  Result<Image<float>> read(Rect part, std::span<const std::string> channels) const;

 private:
  struct Channel {
    std::string name;
    SampleType type = SampleType::kFloat;
    std::int64_t offset = 0;  ///< in a row
  };
  const Channel* find(const std::string& name) const;

  std::filesystem::path file_;
  std::shared_ptr<Descriptor> descriptor_;
  Size size_;
  std::vector<Channel> channels_;
  std::vector<std::int64_t> rows_;  ///< where the samples of each begin
};

}  // namespace weft
