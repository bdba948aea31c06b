// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/vec.h"
#include "material/filtering/roughness_mips.h"
#include "simulator/geometry/settings.h"

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

}  // namespace weft::bench
