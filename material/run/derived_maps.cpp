// SPDX-License-Identifier: Apache-2.0
#include "material/run/derived_maps.h"

namespace weft::material {

const std::vector<DerivedMap>& derived_maps() {
  static const std::vector<DerivedMap> maps = {
      {"height", "millimetres towards the camera", make_height},
      {"curl", "how far slopes are from those of any surface", make_curl},
      {"occlusion", "share of the sky that a point sees, bounces with it, and the bent normal",
       make_occlusion},
      {"cavity", "0 deep, 0.5 flat, 1 high, within --cavity", make_cavity},
      {"roughness", "alpha and f0 of the lobe, measured or that of --cloth", make_roughness},
      {"gloss", "the lobe on the scales of other engines", make_gloss},
      {"mips", "normals and roughness of coarser levels, as bright as the finest", make_mips},
      {"detail", "a layer for other materials: slopes of mean 0, albedo over its mean", make_detail},
      {"opacity", "0 a hole, 1 cloth: by the light below and --bare, else the holes that the solver saw",
       make_opacity}};
  return maps;
}

}  // namespace weft::material
