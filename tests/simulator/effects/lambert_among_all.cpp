// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "simulator/build_passes.h"
#include "tests/simulator/effects/one_frame.h"

int main() {
  using namespace weft::simulator;
  const Scene scene = scene_of_the_frame();
  const auto rig = rig_of(scene);
  if (!rig) return 1;
  auto list = build_passes(scene, *rig, Output::kCounts);
  if (!list) return 1;
  return print_frame(std::move(*list));
}
