// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"
#include "solve/bands/bands.h"

namespace weft::solve {

/// The pitch of a pixel in the middle of the frame, where the cloth lies; 0 where no camera is known.
PixelPitch pitch_in_the_middle(const Photographs& photographs);

/// The map files of a solve, written band by band: docs/formats.md.
class MapFiles {
 public:
  /// `sigma` names the channels of sigma.exr (solve/bands/sigma_channels.h); `pitch_mm` as ImageFileInfo has
  /// it.
  static Result<MapFiles> open(const std::filesystem::path& folder, Size size, Compression compression,
                               const std::vector<std::string>& sigma, PixelPitch pitch_mm);
  /// `sigma` has a view over band.albedo_rows for each of those names.
  Result<void> write(const MapBand& band, std::span<const View<const float>> sigma);
  Result<void> finish();

 private:
  std::optional<ImageWriter> normal_, albedo_, sigma_, residual_, status_;
};

}  // namespace weft::solve
