// SPDX-License-Identifier: Apache-2.0
#include "core/rig/photo_reading.h"

namespace weft {

void describe(Fields& fields, PhotoReading& r) {
  fields.choice({.name = "transfer",
                 .says = "How photographs follow light: auto (16-bit and float linear, 8-bit and JPEG "
                         "sRGB), linear, srgb",
                 .need = kUnlessEmpty},
                r.transfer, kTransferNames);
  fields.choice({.name = "orientation",
                 .says = "How photographs lie under their lights: shown (turned as their tag says), stored",
                 .need = kUnlessEmpty},
                r.orientation, kPictureOrientationNames);
  fields.choice(
      {.name = "flip",
       .says = "What is done to the directions of their lights: none, x, y, z or all turned round, left "
               "or right by a quarter, half (x and y), exchange (x for y), against (x for -y)",
       .need = kUnlessEmpty},
      r.flip, kLightFlipNames);
  fields.value({.name = "mm_per_pixel",
                .says = "Of the cloth, mm; positions of lights are then near lights, in mm over its middle",
                .range = kPixelOfPhotographs_mm,
                .need = kUnlessEmpty},
               r.mm_per_pixel);
  fields.value({.name = "fov_deg",
                .says = "Of the picture's width, degrees; without it, it is seen from far away",
                .range = {0.1, 170},
                .need = kUnlessEmpty,
                .option = "--fov"},
               r.fov_deg);
  fields.value({.name = "ambient",
                .says = "Light that is in all photographs, a share of full scale",
                .range = kNotNegative,
                .need = kUnlessEmpty},
               r.ambient);
}

PhotoReading said_after(PhotoReading said, const PhotoReading& before) {
  const PhotoReading unsaid;
  if (said.transfer == unsaid.transfer) said.transfer = before.transfer;
  if (said.orientation == unsaid.orientation) said.orientation = before.orientation;
  if (said.flip == unsaid.flip) said.flip = before.flip;
  if (said.ambient == unsaid.ambient) said.ambient = before.ambient;
  if (!said.mm_per_pixel) said.mm_per_pixel = before.mm_per_pixel;
  if (!said.fov_deg) said.fov_deg = before.fov_deg;
  return said;
}

}  // namespace weft
