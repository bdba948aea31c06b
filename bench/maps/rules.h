// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "material/filtering/roughness_mips.h"
#include "simulator/geometry/geometry_settings.h"

// What lies beneath a texel, and how it reflects: the truth that mips and joined glosses are held against.

namespace weft::bench {

/// Which distribution of facets a lobe has.
enum class FacetLaw { kGgx, kBeckmann };

/// f (n . l) of a lobe of F0 0.04 by Smith's shadowing and Schlick's Fresnel; 0 where the light is below.
double reflected(Vec3 normal, const material::LobeWidth& lobe, Vec3 to_light, Vec3 to_view,
                 FacetLaw law = FacetLaw::kGgx);

/// A cloth sampled as normals, square.
struct NormalSquare {
  std::string name;
  int side = 0;
  double slope_deg = 0;  ///< mean angle to the level
  std::vector<Vec3> normals;

  Vec3 at(int x, int y) const {
    return normals[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                   static_cast<std::size_t>(x)];
  }
};
NormalSquare normal_square(std::string name, const simulator::GeometrySettings& geometry, int side = 640,
                           double mm_per_pixel = 0.02);

/// Four weaves with the mean slopes that the research measured its table on, and four of other kinds.
std::vector<NormalSquare> page_weaves(int threads);
std::vector<NormalSquare> other_weaves(int threads);

/// Directions of light from all sides, as Lambert's law weighs them.
std::vector<Vec3> cosine_lights(int count, std::mt19937& random);

/// Facet normals of isotropic GGX, by the area that they cover.
std::vector<Vec3> ggx_facets(double alpha, int count, std::mt19937& random);

/// A way to make a texel.
struct MipContender {
  std::string name;
  material::MipRule rule;
  material::NormalWeight weight = material::NormalWeight::kProjected;
};

/// How footprints are looked at.
struct MipTrial {
  double alpha = 0.1;
  int across_px = 16, down_px = 16;  ///< beneath a texel
  double view_deg = 0;
  FacetLaw law = FacetLaw::kGgx;
  double lowest_light_deg = 90;       ///< lights no farther than this from the normal
  double highest_light_deg = 0;       ///< and no nearer
  int footprints = 100, lights = 64;  ///< of each of two azimuths of the view
  int texel_across_px = 0;  ///< what the texel was made of, where that is not what is seen; 0: the same
};

/// Relative rms by contender, and of the best single alpha of each footprint.
struct MipErrors {
  std::vector<double> by_contender;
  double best = 0;
  double alpha = 0;  ///< mean of the best
};
MipErrors mip_errors(const NormalSquare& cloth, const MipTrial& trial,
                     std::span<const MipContender> contenders, std::uint32_t seed);

}  // namespace weft::bench
