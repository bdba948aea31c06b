// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/exr_window.h"
#include "core/image_io/image_io.h"
#include "library/batch/change.h"

// How the maps of one solve differ from those of another of the same photographs.

namespace weft::library {

/// Rows of an EXR map, read from the file where it is uncompressed, else from memory.
class MapRows {
 public:
  /// Errors of read_image(); kBadData where a channel is missing.
  static Result<MapRows> open(const std::filesystem::path& file, std::span<const std::string> channels);
  Size size() const;
  /// A plane a channel of this part, which lies inside.
  Result<Image<float>> read(Rect part) const;

 private:
  std::vector<std::string> channels_;
  std::optional<ExrWindow> window_;
  std::optional<LoadedImage> loaded_;
};

/// Compares the solve in `after` with that in `before`: normals as compare_normals() does, albedo as
/// compare_albedo(), status where both have it, and what both solve.json say. The worst window is the square
/// of 80 pixels, on a grid of 16, with the largest mean angle. Bands of rows are read at a time: 8 bytes a
/// pixel are held, 16 while status is compared, and compressed maps whole. kBadData where sizes differ or no
/// pixel has a normal in both; errors of reading.
Result<MapChange> compare_solves(const std::filesystem::path& before, const std::filesystem::path& after,
                                 int threads);

}  // namespace weft::library
