// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/server/view/viewed_maps.h"
#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/image_io/encode_image.h"

namespace weft::app {

/// Values for programs, little-endian, row by row from the top without gaps: of normals RGB10_A2 with 1022
/// steps, n * 511 + 511, so that a flat cloth is exactly flat; of colours three half floats; of scalars one;
/// of flags a byte, 255 for a share of 1.
std::string raw_tile(LayerKind kind, const Image<float>& planes);

/// How a tile is shown to people.
struct Look {
  double gain = 1;             ///< of colours and of what is relit, linear
  double least = 0, most = 1;  ///< of scalars: the ends of the scale of colours; most above least
  Vec3 light = {-0.5, 0.5, 0.70710678118654752};  ///< of what is relit: to the light, unit, rig frame
};

/// A picture: normals as n * 127 + 127 (PNG alone: what loses would turn them by degrees), colours in sRGB,
/// scalars as report::heat_colour() has them, flags as grey. kUsage for normals as JPEG.
Result<std::string> picture_tile(LayerKind kind, const Image<float>& planes, const Look& look,
                                 PictureFormat format);
/// The cloth under one distant lamp: gain * albedo * max(0, n . light), in sRGB.
Result<std::string> relit_tile(const Image<float>& normal, const Image<float>& albedo, const Look& look,
                               PictureFormat format);
/// Degrees between two maps of normals.
Image<float> turned_deg(const Image<float>& normal, const Image<float>& other);
/// By how many percent of the other's an albedo is off, either way: the mean of the channels that are above 0
/// in the other, 0 where none is.
Image<float> off_percent(const Image<float>& albedo, const Image<float>& other);

}  // namespace weft::app
