// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/image/image.h"

namespace weft::bench {

/// A mesh of crossed yarns over a light, or a lace of it with round holes that yarns run around.
struct MeshScene {
  int side_px = 160;
  double pitch_px = 12, yarn_px = 5;
  bool is_lace = false;
  double through_yarns = 0;  ///< share of light
  double thrown_back = 0;    ///< reflectance of the diffuser towards cloth that throws light back onto it
  double blur_px = 0.4;      ///< standard deviation
  double defocus_px = 0.5;   ///< diameter of the disc
  std::uint32_t seed = 1;
};

struct RenderedMesh {
  Image<float> coverage;  ///< as the optics see it
  Image<float> share;     ///< of the bare light, with photon and read noise of 28000 electrons
};

/// Six by six samples a pixel.
RenderedMesh rendered(const MeshScene& scene);

}  // namespace weft::bench
