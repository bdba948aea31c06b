// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "app/server/view/viewed_maps.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/image_io/exr_window.h"

namespace weft::app {

/// Tiles have this many pixels a side, those at the right and lower edge fewer.
inline constexpr int kTileSide = 512;
/// The last level has no longer side.
inline constexpr int kLeastSide = 128;

/// Levels of a map of this size.
int levels_of(Size size);

/// A layer at its size (level 0), at half of it (level 1) and so on, to one of at most kLeastSide, which is
/// there at once on any line. Odd sides are rounded up.
///
/// A pixel of a level is the average of the four below it, by what the layer holds: normals as vectors, not
/// brought back to unit length, so that the cloth relit from afar is as bright as from close by; deviations
/// as the root of the mean of their squares; flags as the share of pixels that have them.
///
/// Levels 0 and 1 are cut from the map. Those from 2 on, and level 0 of a map that cannot be cut (compressed,
/// PNG, raw), are made when they are first asked for and kept as EXR files in `kept`, which may be emptied at
/// any time. Safe from any thread.
class Pyramid {
 public:
  /// Opens a map of a folder. Errors of ExrWindow::open(), read_image(), and of writing to `kept`.
  static Result<std::unique_ptr<Pyramid>> open(const std::filesystem::path& folder, const Layer& layer,
                                               const std::filesystem::path& kept);
  /// Opens a raw frame, as shares of the way from black to white, R, G, B. At level 0 each photosite shows
  /// the colours of its cell of the filter pattern. Errors of capture::decode_raw().
  static Result<std::unique_ptr<Pyramid>> open_raw(const std::filesystem::path& file,
                                                   const std::filesystem::path& kept);

  const Layer& layer() const { return layer_; }
  int levels() const;
  /// The first level that fits one tile.
  int top() const;
  Size size(int level) const;
  /// The pixels of a tile; empty where there is none.
  std::optional<Rect> tile(int level, int column, int row) const;
  /// The planes of `part` of a level. Of flags one plane: the share of pixels with the bit number `bit`, or
  /// with any bit at all where it is -1. Errors of reading and, where levels are made, of writing.
  Result<Image<float>> read(int level, Rect part, int bit = -1);

 private:
  Pyramid(Layer layer, std::filesystem::path kept) : layer_(std::move(layer)), kept_(std::move(kept)) {}
  std::filesystem::path file_of(int level) const;
  std::vector<std::string> channels_of(int level) const;
  Result<void> unpack(const std::filesystem::path& map);
  Result<void> keep(int level, const Image<float>& image, const std::vector<std::string>& channels) const;
  Result<ExrWindow> window_of(int level);
  Result<void> make_levels();
  Result<Image<float>> read_flags(int level, Rect part);
  Result<Image<float>> read_halved(Rect part);
  Result<Image<float>> read_mosaic(Rect part);

  Layer layer_;
  std::filesystem::path kept_;
  Size size_;
  std::optional<ExrWindow> map_;
  CfaPattern cfa_;  // of a mosaic
  std::mutex making_;
};

}  // namespace weft::app
