// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "material/surface.h"

// A cloth as a layer over another material: its weave without its colour, its tilt and its height.

namespace weft::material {

/// Pixels over which means are taken: whole repeats of the weave, or the layer would tilt what it lies on.
struct RepeatSize {
  double x_px = 0, y_px = 0;  ///< of one repeat; 0: not known
};

struct DetailOptions {
  RepeatSize repeat;  ///< counts where the surface is no tile
  int threads = 0;
};

/// What was taken out. Adding it again, or multiplying by it, gives the surface back.
struct DetailFacts {
  double slope_x = 0, slope_y = 0;           ///< mm a mm
  std::array<double, 3> albedo = {1, 1, 1};  ///< mean of each channel
  double height_mm = 0;
  double share_of_frame = 1;  ///< that the means were taken over
};

struct DetailLayer {
  Image<float> slope;      ///< 2 planes, of mean 0 over whole repeats
  Image<float> albedo;     ///< 3 planes, over the mean: of mean 1 over whole repeats
  Image<float> height_mm;  ///< of mean 0; empty where no height was given
  DetailFacts facts;
};

/// Means are those of pixels that have a solution, weighed by opacity, over as many whole repeats from the
/// top left as the surface holds: all of it where it is a tile or no repeat is known. A channel whose mean is
/// not above 0 becomes 1 everywhere; pixels without a solution have slope 0, albedo 1 and height 0.
/// `height_mm` may be empty. kUsage for a height of another size and a repeat that is larger than the
/// surface, kBadData where nothing has a solution.
Result<DetailLayer> detail_layer(const Surface& surface, View<const float> height_mm,
                                 const DetailOptions& options = {});

/// How an engine joins the normals of a layer with those of what it lies on.
enum class NormalBlend {
  kAddSlopes,  ///< exact for heights that add up
  kWhiteout,   ///< (x + x', y + y', z z'): between the other two
  kRnm,        ///< reoriented normals (Barre-Brisebois and Hill 2012): exact for detail that follows the base
  kBlendXy,    ///< x and y added, z from the rest: seed 001 algorithm 4; exact for neither
};
const char* name_of(NormalBlend blend);
std::optional<NormalBlend> normal_blend_named(std::string_view name);

/// Blends unit normals whose z is above 0; the result has unit length.
Vec3 blended(Vec3 base, Vec3 detail, NormalBlend blend);

}  // namespace weft::material
