// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/camera/boards.h"
#include "calibration/camera/markers.h"
#include "core/image/image.h"
#include "core/rig/calibration.h"
#include "core/rig/camera.h"

// What a camera's finder shows: the whole frame in few pixels, by an exposure of the camera's own choice. It
// serves to lay things by, and measures nothing.

namespace weft::calibration {

/// A picture of the finder (JPEG), grey and up to four times as large, as many as make it 1280 pixels
/// wide: tags are too small in it to be found as they are. Nothing where the bytes are no JPEG.
std::optional<Image<std::uint8_t>> finder_picture(const std::string& jpeg);

/// The same place as a share of the frame's width and height, from its upper left corner.
inline PixelPoint share_of(const PixelPoint& px, Size size) {
  return {(px.x + 0.5) / size.width, (px.y + 0.5) / size.height};
}

/// How far tags are seen from where they belong.
struct TagOffsets {
  int tags = 0;       ///< that belong somewhere
  double rms_mm = 0;  ///< of their corners, in the plane of each tag
};
/// Offsets of tags seen in a picture of `size` that shows the whole frame of `camera`. Nothing where none of
/// them belongs anywhere.
std::optional<TagOffsets> offsets_of(std::span<const TagSighting> tags, Size size, const CameraModel& camera,
                                     std::span<const Fiducial> fiducials);

/// The convex outline of a board's corners, clockwise, as shares of the picture.
std::vector<PixelPoint> outline_of(std::span<const BoardCorner> corners, Size size);

}  // namespace weft::calibration
