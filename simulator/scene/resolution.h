// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "simulator/scene/scene.h"

namespace weft::simulator {

/// The same piece of cloth at another resolution, with more or fewer pixels a millimetre; sides stay even.
inline void resize(CameraSettings& camera, double megapixels) {
  const double factor = std::sqrt(megapixels * 1e6 / (static_cast<double>(camera.width) * camera.height));
  const auto even = [&](int side) {
    return std::max(2, 2 * static_cast<int>(std::lround(side * factor / 2)));
  };
  const int width = even(camera.width);
  camera.mm_per_pixel *= static_cast<double>(camera.width) / width;
  camera.height = even(camera.height);
  camera.width = width;
}

}  // namespace weft::simulator
