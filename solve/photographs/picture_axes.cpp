// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/picture_axes.h"

#include <cmath>

namespace weft::solve {

Mat3 picture_from_rig(const std::optional<CameraModel>& camera) {
  double c = 1, s = 0;
  if (camera) {
    // The first row of the rotation is the camera's x axis, which runs along columns, as the rig sees it.
    const auto& columns = camera->camera_from_rig_rotation[0];
    const double across = std::hypot(columns[0], columns[1]);
    if (across > 0) {
      c = columns[0] / across;
      s = columns[1] / across;
    }
  }
  return {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
}

}  // namespace weft::solve
