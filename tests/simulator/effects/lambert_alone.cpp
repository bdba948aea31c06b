// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "simulator/effects/effects.h"
#include "tests/simulator/effects/one_frame.h"

int main() {
  using namespace weft::simulator;
  const Scene scene = scene_of_the_frame();
  const auto rig = rig_of(scene);
  if (!rig) return 1;
  PassList list;
  list.passes = {camera_pass(scene, *rig), geometry_pass(scene),      albedo_pass(scene, true),
                 near_light_pass(*rig),    lambert_pass(scene, *rig), mosaic_pass(0),
                 converter_pass(*rig)};
  return print_frame(std::move(list));
}
