// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/describe/fields.h"
#include "core/image/transfer.h"

// What a person says of photographs that no rig took.

namespace weft {

/// Whether directions of lights are those of the picture as it is shown, by its tag Orientation, or as its
/// rows are stored.
enum class PictureOrientation { kShown, kStored };
inline constexpr std::array<const char*, 2> kPictureOrientationNames = {"shown", "stored"};

/// What is done to directions of lights that mean other axes than x right, y up, z to the camera.
enum class LightFlip { kNone, kX, kY, kZ, kAll, kLeft, kRight, kExchange, kAgainst, kHalf };
inline constexpr std::array<const char*, 10> kLightFlipNames = {
    "none", "x", "y", "z", "all", "left", "right", "exchange", "against", "half"};

inline const char* name_of(LightFlip flip) {
  return kLightFlipNames[static_cast<std::size_t>(flip)];
}

/// How small and how large a pixel of photographs may be on the cloth.
inline constexpr NumberRange kPixelOfPhotographs_mm = {1e-4, 100};

/// How photographs and their lights are read: options of a command, and `photographs` of a
/// session.json.
struct PhotoReading {
  Transfer transfer = Transfer::kAuto;
  PictureOrientation orientation = PictureOrientation::kShown;
  LightFlip flip = LightFlip::kNone;
  double ambient = 0;  ///< light that is in all of them, a share of full scale
  /// How large a pixel is on the cloth, mm; none: not known. With it positions of lights are near lights, in
  /// mm.
  std::optional<double> mm_per_pixel = {};
  std::optional<double> fov_deg = {};  ///< of the picture's width; none: seen from far away

  friend bool operator==(const PhotoReading&, const PhotoReading&) = default;
};
void describe(Fields& fields, PhotoReading& reading);

/// `said`, and what it does not say as it was said `before`.
PhotoReading said_after(PhotoReading said, const PhotoReading& before);

}  // namespace weft
