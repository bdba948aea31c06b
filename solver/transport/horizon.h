// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/transport/relief.h"

namespace weft::solver {

struct HorizonSettings {
  int slices = 4;      ///< planes through the vertical, from 1 to 64
  int steps = 8;       ///< to each side, from 1 to 256
  int radius_px = 48;  ///< of the farthest step, to 8192; at least two periods of the yarns
};

/// Openness: the share of the sky, weighted by the cosine to the normal, that is not behind the
/// horizon. In each of `slices` vertical planes the horizon is the steepest line to one of `steps` points on
/// either side, at h1 <= 0 <= h2 from the vertical, and with gamma the angle of the normal in the plane and
/// |p| its length there the share is
///     |p| / 4 * (cos gamma - cos(2 h1 - gamma) + 2 h1 sin gamma + the same of h2)
/// (Jimenez, Wu, Pesce and Jarabo, "Practical real-time strategies for accurate indirect occlusion", 2016,
/// eq. 7), with h1, h2 held within 90 degrees of gamma. Steps are closer near the pixel (their distance grows
/// as a square), and both slices and steps are turned and moved by the pixel's hash, so that the mean over a
/// tile is that of many more. What lies between two steps is not seen, so openness is too high: with 4 x 8
/// steps by 0.002 in the mean on a plain weave and 0.018 on a deep one (openness 0.94 and 0.79), less than a
/// gate asks for. Eight rays a pixel take as long and have no such error, but need a mesh.
///
/// `openness(x - tile.x0, y - tile.y0)`; normals as in gather_by_slices. Beyond the relief's border nothing
/// rises. kBadData for settings out of range, a tile not inside the relief and planes that do not fit.
Result<void> scan_openness(const Relief& relief, Rect tile, const Normals& normals,
                           const HorizonSettings& settings, View<float> openness);

}  // namespace weft::solver
