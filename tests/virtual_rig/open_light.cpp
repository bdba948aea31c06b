// SPDX-License-Identifier: Apache-2.0
// open_light CACHE WIDTH [kill]: opens the light of a scene of that width and says whether it rendered it.
// With "kill" it ends by SIGKILL half-way through rendering.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "virtual_rig/light/light_frames.h"

int main(int argc, char** argv) {
  using namespace weft::virtual_rig;
  if (argc < 3) return 64;
  weft::simulator::Scene scene;
  scene.camera.width = std::atoi(argv[2]);
  scene.camera.height = 600;  // several bands of rows
  scene.effects.near_light = true;
  bool has_rendered = false;
  RenderLightOptions options;
  options.progress = [&](double) {
    has_rendered = true;
    if (argc > 3) std::raise(SIGKILL);
  };
  const auto frames = LightFrames::open(scene, argv[1], options);
  if (!frames) {
    std::fprintf(stderr, "%s\n", frames.error().message().c_str());
    return 1;
  }
  std::puts(has_rendered ? "rendered" : "found");
  return 0;
}
