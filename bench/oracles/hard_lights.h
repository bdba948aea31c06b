// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "core/rig/light_field.h"
#include "core/rig/lights.h"
#include "solver/method.h"

namespace weft::test {

/// `count` distant lights of irradiance 1 evenly around an axis that leans 20 degrees from z towards x, as
/// close to it as makes the condition number of their directions `condition` (from 1.001 to 1e7). Directions
/// are exact in float32, so that every precision is given the same ones.
DistantLights clustered_lights(std::size_t count, double condition);
/// Where they point.
Vec3 cluster_axis();

/// Six LEDs in a plane that also holds the point of the cloth that pixel (kLinePixel, y) sees, in a frame of
/// kLineFrame: j pixels beside that line the condition number is about `condition_beside` / j. At the frame's
/// centre and corners it is below 1e6 for `condition_beside` up to 1e8.
LightField coplanar_field(double condition_beside);
inline constexpr int kLinePixel = 1024;
inline constexpr Size kLineFrame = {4096, 4};

/// check(method, name, planes) for every method by its name, on each kind of photograph that it takes.
void for_each_method(
    const std::function<void(const solver::Method& method, const std::string& name, int planes)>& check);

/// What sets one method apart from another where a case is hard.
struct Promise {
  bool one_weight = false;    ///< minimises the plain sum of squares over what it uses: quad is its oracle
  bool masks_shadow = false;  ///< leaves out readings too dark to be lit
};
/// A method without an entry promises neither.
Promise promise_of(const std::string& method);

}  // namespace weft::test
